//! A browser without a window, where one is installed.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// The browser's name; says so on the terminal where there is none.
pub fn browser() -> Option<&'static str> {
    let answers = |name: &&str| {
        Command::new(name)
            .arg("--version")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|s| s.success())
    };
    let found = NAMES.into_iter().find(|name| answers(name));
    if found.is_none() {
        println!("skipped: no Chromium is installed");
    }
    found
}

/// What the browser did: its document, and what was said on its console.
pub struct Visit {
    pub document: String,
    pub console: Vec<String>,
}

/// Opens a file with `fragment` after `#` and waits until the page says that it is loaded.
#[allow(dead_code, reason = "not every suite has files")]
pub fn visit(browser: &str, page: &Path, fragment: &str, arguments: &[&str]) -> Visit {
    visit_address(browser, &format!("file://{}#{fragment}", page.display()), arguments)
}

/// Opens an address and waits until the page says that it is loaded.
pub fn visit_address(browser: &str, address: &str, arguments: &[&str]) -> Visit {
    let folder = tempfile::tempdir().expect("a folder for the browser's profile");
    let out = folder.path().join("document");
    let log = folder.path().join("log");
    let mut child = Command::new(browser)
        .args(["--headless=new", "--no-sandbox", "--no-first-run", "--disable-extensions", "--hide-scrollbars"])
        .args(["--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader", "--enable-logging=stderr"])
        .arg("--dump-dom")
        .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
        .args(arguments)
        .arg(address)
        .stdout(std::fs::File::create(&out).unwrap())
        .stderr(std::fs::File::create(&log).unwrap())
        .spawn()
        .expect("the browser starts");
    let begin = Instant::now();
    while child.try_wait().expect("the browser is a process of this test").is_none() {
        if begin.elapsed() > Duration::from_secs(120) {
            child.kill().expect("the browser is a process of this test");
            panic!("the browser does not end: {}", std::fs::read_to_string(&log).unwrap_or_default());
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let text = |path: &Path| String::from_utf8_lossy(&std::fs::read(path).unwrap_or_default()).into_owned();
    let console = text(&log).lines().filter(|line| line.contains(":CONSOLE")).map(str::to_owned).collect();
    Visit { document: text(&out), console }
}
