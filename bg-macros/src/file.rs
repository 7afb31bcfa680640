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
    let full = root.join(path);
    let error = |text: &str| quote_spanned!(*span => ::core::compile_error!(#text););
    let text = match std::fs::read_to_string(&full) {
        Ok(text) => text,
        Err(fault) => return error(&format!("cannot read `{path}`: {fault}\nhelp: the path begins beside Cargo.toml")),
    };
    // With this rustc builds anew where the file changes.
    let watched = full.display().to_string();
    let mut items = quote!(
        const _: &[::core::primitive::u8] = ::core::include_bytes!(#watched);
    );
    let Ok(tokens) = text.parse::<TokenStream>() else {
        items.extend(error(&format!("{path}: a bracket or a quote is out of place\nhelp: close what is open")));
        return items;
    };
    let (compiled, is_faulty) = bg_compiler::compile_items(tokens);
    items.extend(compiled);
    if is_faulty {
        items.extend(faults(&text).iter().map(|fault| {
            let place = fault.span.start();
            error(&format!("{path}:{}:{}: {fault}", place.line, place.column + 1))
        }));
    }
    items
}

/// The faults of a text with their places in it.
fn faults(text: &str) -> Faults {
    fallback::force();
    let tokens = text.parse::<TokenStream>().unwrap_or_default();
    let faults = syntax::parse(tokens).and_then(|source| pipeline::models(&source)).err().unwrap_or_default();
    if proc_macro::is_available() {
        fallback::unforce();
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compiled(name: &str, text: &str) -> String {
        let folder = std::env::temp_dir().join(format!("bond-graph-file-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        std::fs::write(folder.join(name), text).expect("a file");
        let tokens = format!("file \"{name}\"").parse().expect("tokens");
        compile(&named(&tokens).expect("a file is named"), &folder).to_string()
    }

    #[test]
    fn a_file_is_as_a_call() {
        let graph = "graph Coil { 1 wire: electrical; I coil = 2; wire -> coil; }";
        let tokens: TokenStream = graph.parse().expect("tokens");
        let own = bg_compiler::compile(tokens.clone()).to_string();
        assert!(named(&tokens).is_none() && compiled("coil.bond", graph).ends_with(&own));
    }

    #[test]
    fn faults_say_line_and_column_in_the_file() {
        let text = compiled("bad.bond", "graph Coil {\n    1 wire: electrical;\n    I coil = 2; wire -> coli;\n}");
        assert!(text.contains("bad.bond:3:25: [BG0303] nothing is called `coli`"), "{text}");
        let tokens = "file \"missing.bond\"".parse().expect("tokens");
        let text = compile(&named(&tokens).expect("a file"), Path::new("nowhere")).to_string();
        assert!(text.contains("cannot read `missing.bond`"), "{text}");
    }
}
