//! Makes the reference solutions in `hacksaw/reference` anew: a table and its certificate for each case.
//!
//! `cargo run --release -p hacksaw --example make_references -- [NAME]...` with names of `paper`, `full_offset`,
//! `rigid`, `free_run`; all of them without a name. `full_offset` is stiff and takes up to half an hour, the others
//! seconds.

use std::error::Error;
use std::fs::{File, write};
use std::path::Path;
use std::time::Instant;

use hacksaw::precision::reference::Reference;

fn main() -> Result<(), Box<dyn Error>> {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let known = |name: &String| Reference::ALL.iter().any(|reference| reference.name() == name);
    if let Some(unknown) = names.iter().find(|name| !known(name)) {
        return Err(format!("no reference is called `{unknown}`").into());
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference");
    for reference in Reference::ALL {
        let name = reference.name();
        if !names.is_empty() && !names.iter().any(|wanted| wanted == name) {
            continue;
        }
        let clock = Instant::now();
        let (samples, certificate) = reference.make()?;
        samples.write_csv(File::create(folder.join(name).with_extension("csv"))?)?;
        write(folder.join(name).with_extension("toml"), toml::to_string(&certificate)?)?;
        println!("{name}: {:.1} s\n{}", clock.elapsed().as_secs_f64(), toml::to_string(&certificate)?);
    }
    Ok(())
}
