//! The page that compiles, from a folder of files, on this machine alone.
//!
//! In: the folder that `bond-page` writes, a port. Out: the address of a server that gives the files of that folder to
//! a browser and nothing else: no folders in it, no files elsewhere.

use std::net::Ipv4Addr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use thiserror::Error;
use tiny_http::{Header, Method, Request, Response, Server};

/// The folder beside the program in which the page is sought unless another one is said.
pub const FOLDER: &str = "bond-site";
/// The page in it.
const INDEX: &str = "index.html";

/// A page that cannot be served.
#[derive(Debug, Error)]
pub enum ServeFault {
    /// The folder has no page.
    #[error(
        "there is no page in {}; write one by `cargo run --release -p bond-page -- FOLDER` in the project's folder, \
         and say --page FOLDER", .0.display()
    )]
    NoPage(PathBuf),
    /// The port cannot be had.
    #[error("--port {port}: {fault}")]
    Port {
        /// Its number.
        port: u16,
        /// Why.
        fault: String,
    },
}

/// Where the page is unless another folder is said: beside the running program.
#[must_use]
pub fn usual() -> PathBuf {
    let program = std::env::current_exe().unwrap_or_default();
    program.parent().map_or_else(|| FOLDER.into(), |folder| folder.join(FOLDER))
}

/// Starts to serve the page in a folder, by [`answering`]; gives its address.
///
/// # Errors
/// [`ServeFault`].
pub fn start(folder: &Path, port: u16) -> Result<String, ServeFault> {
    if !folder.join(INDEX).is_file() {
        return Err(ServeFault::NoPage(folder.to_owned()));
    }
    let folder = folder.to_owned();
    answering(port, move |request| answer(request, &folder))
}

/// Starts to answer each request in a thread of its own, since an answer may wait, or be left unread for a while: on a
/// port of this machine that others do not reach; 0 is a free one. Gives the address.
///
/// # Errors
/// The port cannot be had.
pub fn answering(port: u16, answer: impl Fn(Request) + Send + Sync + 'static) -> Result<String, ServeFault> {
    let server = Server::http((Ipv4Addr::LOCALHOST, port));
    let server = server.map_err(|fault| ServeFault::Port { port, fault: fault.to_string() })?;
    let address = format!("http://{}/", server.server_addr());
    let answer = Arc::new(answer);
    std::thread::spawn(move || {
        for request in server.incoming_requests() {
            let answer = Arc::clone(&answer);
            std::thread::spawn(move || answer(request));
        }
    });
    Ok(address)
}

/// A line in the head of an answer.
///
/// # Panics
/// It is no ASCII.
#[must_use]
pub fn header(name: &str, value: &str) -> Header {
    Header::from_bytes(name, value).expect("ASCII")
}

fn answer(request: Request, folder: &Path) {
    let path = request.url().split(['?', '#']).next().unwrap_or_default();
    let name = match path.strip_prefix('/') {
        Some("") => Some(INDEX),
        name => name.filter(|name| is_of_the_folder(name)),
    };
    let is_asked = matches!(request.method(), Method::Get | Method::Head);
    let file = name.filter(|_| is_asked).and_then(|name| Some((kind(name), std::fs::read(folder.join(name)).ok()?)));
    // A browser that has gone away is no fault.
    let _ = match file {
        Some((kind, bytes)) => request.respond(
            Response::from_data(bytes)
                .with_header(header("Content-Type", kind))
                .with_header(header("Cache-Control", "no-cache")),
        ),
        None => request.respond(Response::empty(404)),
    };
}

/// Whether it is a name of a file, and of nothing above the folder or in another one.
fn is_of_the_folder(name: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    !name.starts_with('.') && name.chars().all(is_plain)
}

/// The type of a file by its ending.
#[must_use]
pub fn kind(name: &str) -> &'static str {
    match name.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("json") => "application/json",
        Some("wasm") => "application/wasm",
        _ => "text/plain; charset=utf-8",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_in_the_folder() {
        for name in ["page.js", "THIRD-PARTY.txt", "bond.wasm"] {
            assert!(is_of_the_folder(name), "{name}");
        }
        for name in ["..", ".run", "../a", "a/b", "a\\b", "%2e%2e", "C:a"] {
            assert!(!is_of_the_folder(name), "{name}");
        }
    }
}
