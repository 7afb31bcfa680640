//! A unit as a file: the archive of a library and its description.
//!
//! In: a model, how it is packed, the bytes of its library. Out: the bytes of NAME.fmu: `modelDescription.xml`, the
//! library in the folder of its platform, its resources, and what tells variables that belong together, if any do.
//! Source: FMI 3.0.1, section 2.5, and 2.0.4, section 2.3.

use std::io::{self, Cursor, Error, Write};

use rawzip::{CompressionMethod, DataDescriptorOutput, ZipArchiveWriter};

use crate::description::{Packing, Version, model_description, terminals_and_icons};
use crate::exported::Described;

/// How hard the compressor tries, of 10: at 6 a library of 13 MB takes a second, and a tenth less room.
const LEVEL: u8 = 1;

/// The folder of a unit that has the libraries of this platform: `x86_64-linux` in FMI 3.0 (3.0.1, section 2.5.1.4.1),
/// `linux64` in FMI 2.0 (2.0.4, section 2.3), which does not tell processors apart.
#[must_use]
pub fn platform(version: Version) -> String {
    let system = match std::env::consts::OS {
        "macos" => "darwin",
        system => system,
    };
    match version {
        Version::Three => format!("{}-{system}", std::env::consts::ARCH),
        Version::Two => format!("{}{}", if system == "windows" { "win" } else { system }, usize::BITS),
    }
}

/// The file name of the library `identifier` on this platform, in a unit.
#[must_use]
pub fn library_name(identifier: &str) -> String {
    format!("{identifier}{}", std::env::consts::DLL_SUFFIX)
}

/// The bytes of the unit of `model`, whose `library` is one for this platform that exports it, by these `resources`,
/// names and contents of files, where it needs some.
///
/// # Errors
/// The library is larger than an archive takes.
pub fn archive(
    model: &dyn Described,
    packing: &Packing,
    library: &[u8],
    resources: &[(&str, Vec<u8>)],
) -> io::Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    let place = format!("binaries/{}/{}", platform(packing.version), library_name(&packing.identifier));
    let description = model_description(model, packing);
    let terminals = terminals_and_icons(model);
    let terminals = terminals.as_ref().map(|text| ("terminalsAndIcons/terminalsAndIcons.xml", text.as_bytes()));
    let files = [("modelDescription.xml", description.as_bytes()), (&place, library)];
    let resources: Vec<(String, &[u8])> =
        resources.iter().map(|(name, content)| (format!("resources/{name}"), &content[..])).collect();
    let resources = resources.iter().map(|(name, content)| (name.as_str(), *content));
    for (name, content) in files.into_iter().chain(terminals).chain(resources) {
        let entry = archive.new_file(name).compression_method(CompressionMethod::DEFLATE);
        let (mut entry, _) = entry.start().map_err(Error::other)?;
        entry.write_all(&miniz_oxide::deflate::compress_to_vec(content, LEVEL))?;
        let described = DataDescriptorOutput::new(rawzip::crc32(content), content.len() as u64);
        entry.finish(described).map_err(Error::other)?;
    }
    archive.finish().map_err(Error::other)?;
    Ok(bytes.into_inner())
}
