//! Graphs in a file of their own: `bond_graph!(file "saw.bond");`.
//!
//! In: the tokens of a call. Out: the file that it names; the items of the file's graphs. The file is that of the
//! program `bond`: a mechanism moves from one to the other as it is.
//!
//! Tokens of a file have no places for rustc, which shows faults at the call. So each says line and column in the file,
//! which the text is read again for.

use std::path::Path;

use bg_compiler::fault::Faults;
use bg_compiler::pipeline;
use bg_compiler::source::syntax;
use bg_compiler::source::syntax::files::{self, Gathered, Opened};
use proc_macro2::{Span, TokenStream, TokenTree, fallback};
use quote::{quote, quote_spanned};

/// A file that a call names.
#[derive(Debug)]
pub struct Named {
    path: String,
    span: Span,
}

/// The file that a call names; none of a call with graphs in it.
pub fn named(tokens: &TokenStream) -> Option<Named> {
    let tokens: Vec<TokenTree> = tokens.clone().into_iter().collect();
    match &tokens[..] {
        [TokenTree::Ident(word), TokenTree::Literal(path)] if word == "file" => {
            let text: syn::LitStr = syn::parse2(TokenTree::Literal(path.clone()).into()).ok()?;
            Some(Named { path: text.value(), span: path.span() })
        }
        _ => None,
    }
}

/// The items of its graphs. The path begins at `root`, the folder of the crate.
pub fn compile(Named { path, span }: &Named, root: &Path) -> TokenStream {
    let error = |text: &str| quote_spanned!(*span => ::core::compile_error!(#text););
    let first = match open(root, Path::new(path)) {
        Ok(first) => first,
        Err(fault) => return error(&format!("{fault}\nhelp: the path begins beside Cargo.toml")),
    };
    let gather = || files::gather(Path::new(path), first.clone(), &|path| open(root, path));
    let gathered = gather();
    // With these rustc builds anew where a file changes.
    let of_user = gathered.files.iter().filter(|file| !file.is_of_library);
    let watched = of_user.map(|file| root.join(&file.path).display().to_string());
    let mut items = quote!(#(const _: &[::core::primitive::u8] = ::core::include_bytes!(#watched);)*);
    let mut is_faulty = !gathered.faults.is_empty();
    if !is_faulty {
        let (compiled, has_faults) = bg_compiler::compile_items(gathered.tokens);
        items.extend(compiled);
        is_faulty = has_faults;
    }
    if is_faulty {
        items.extend(places(gather).iter().map(|fault| error(fault)));
    }
    items
}

fn open(root: &Path, path: &Path) -> Result<Opened, String> {
    let full = root.join(path);
    let text = std::fs::read_to_string(&full).map_err(|fault| format!("cannot read `{}`: {fault}", path.display()))?;
    Ok(Opened { file: full.canonicalize().unwrap_or(full), text })
}

/// The faults of a text with their places in its files.
fn places(gather: impl Fn() -> Gathered) -> Vec<String> {
    fallback::force();
    let gathered = gather();
    let told = |fault| {
        let fault = gathered.named(fault);
        let (file, place) = (&gathered.files[gathered.place(fault.span)].path, fault.span.start());
        format!("{}:{}:{}: {fault}", file.display(), place.line, place.column + 1)
    };
    let told = faults(&gathered).into_iter().map(told).collect();
    if proc_macro::is_available() {
        fallback::unforce();
    }
    told
}

fn faults(gathered: &Gathered) -> Faults {
    if !gathered.faults.is_empty() {
        return gathered.faults.clone();
    }
    let models = syntax::parse(gathered.tokens.clone()).and_then(|source| pipeline::models(&source));
    models.err().unwrap_or_default()
}
