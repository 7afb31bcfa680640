//! What a notebook shows: pictures and pages.

use std::path::PathBuf;

use bg_workbench::markup::escaped;
use pyo3::prelude::*;

/// A picture, which a notebook shows.
#[pyclass(frozen)]
pub struct Picture {
    /// The picture as SVG.
    #[pyo3(get)]
    pub(crate) svg: String,
}

#[pymethods]
impl Picture {
    /// What a notebook shows.
    fn _repr_svg_(&self) -> &str {
        &self.svg
    }

    /// Write it into a file.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        Ok(std::fs::write(path, &self.svg)?)
    }

    fn __repr__(&self) -> String {
        format!("<Picture of {} characters; save(path) writes it>", self.svg.len())
    }
}

/// A page, which a notebook shows.
#[pyclass(frozen)]
pub struct Page {
    /// The page as HTML, in one text with all that it needs.
    #[pyo3(get)]
    pub(crate) html: String,
}

#[pymethods]
impl Page {
    /// What a notebook shows: the page in a frame of its own.
    fn _repr_html_(&self) -> String {
        let text = escaped(&self.html);
        format!("<iframe srcdoc=\"{text}\" style=\"width: 100%; height: 40em; border: 0\"></iframe>")
    }

    /// Write it into a file.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        Ok(std::fs::write(path, &self.html)?)
    }

    fn __repr__(&self) -> String {
        format!("<Page of {} characters; save(path) writes it>", self.html.len())
    }
}
