//! Compiled for WebAssembly: what answers the page. Else: writes the page's files into a folder.

#[cfg(target_arch = "wasm32")]
fn main() {
    let answerer = bond_page::answers::Answerer::default();
    bg_live::register(move |question| answerer.answer(question));
}

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    use clap::Parser;

    match bond_page::site::write(&Arguments::parse().folder) {
        Ok(told) => {
            println!("{told}");
            std::process::ExitCode::SUCCESS
        }
        Err(fault) => {
            eprintln!("error: {fault}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// Builds the compiler for WebAssembly and writes the page that compiles: files for any static server, or for `bond
/// serve --page FOLDER`
#[cfg(not(target_arch = "wasm32"))]
#[derive(clap::Parser)]
#[command(name = "bond-page", version)]
struct Arguments {
    /// The folder; it is made where there is none
    folder: std::path::PathBuf,
}
