//! Where a page is served, and that it is shown.

use bg_workbench::files::console;

/// Where the page is served.
#[derive(Debug, PartialEq, Eq, clap::Args)]
pub struct Served {
    /// The port of the page; a free one unless given
    #[arg(long, value_name = "NUMBER", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Opens no browser
    #[arg(long)]
    pub no_open: bool,
}

impl Served {
    /// Says that the page at `address` shows `what`, and opens it in the browser.
    ///
    /// # Errors
    /// It cannot be said: a sentence.
    pub fn show(&self, address: &str, what: &str) -> Result<(), String> {
        let told = console::print(&format!("{address} shows {what}; Ctrl-C ends\n"));
        told.map_err(|fault| fault.to_string())?;
        if !self.no_open && open::that_detached(address).is_err() {
            console::note(&format!("no browser was found; open {address}"));
        }
        Ok(())
    }
}
