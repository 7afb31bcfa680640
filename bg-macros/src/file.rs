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

#[cfg(test)]
mod tests {
    use super::*;

    /// The items of the first of these files, in a folder of their own.
    fn compiled(files: &[(&str, &str)]) -> String {
        let name = files[0].0;
        let folder = std::env::temp_dir().join(format!("bond-graph-file-{}-{name}", std::process::id()));
        std::fs::create_dir_all(folder.join("parts")).expect("a folder");
        files.iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).expect("a file"));
        let tokens = format!("file \"{name}\"").parse().expect("tokens");
        let items = compile(&named(&tokens).expect("a file is named"), &folder).to_string();
        std::fs::remove_dir_all(folder).expect("it is there");
        items
    }

    #[test]
    fn a_file_is_as_a_call() {
        let graph = "graph Coil { 1 wire: electrical; I coil = 2; wire -> coil; }";
        let tokens: TokenStream = graph.parse().expect("tokens");
        let own = bg_compiler::compile(tokens.clone()).to_string();
        assert!(named(&tokens).is_none() && compiled(&[("coil.bond", graph)]).ends_with(&own));
    }

    #[test]
    fn faults_say_line_and_column_in_the_file() {
        let text = compiled(&[("bad.bond", "graph Coil {\n    1 wire: electrical;\n    I coil = 2; wire -> coli;\n}")]);
        assert!(text.contains("bad.bond:3:25: [BG0303] nothing is called `coli`"), "{text}");
        let text = compiled(&[("open.bond", "graph Coil {\n    1 wire")]);
        assert!(text.contains("open.bond:1:12: [BG0906]"), "{text}");
        let tokens = "file \"missing.bond\"".parse().expect("tokens");
        let text = compile(&named(&tokens).expect("a file"), Path::new("nowhere")).to_string();
        assert!(text.contains("cannot read `missing.bond`"), "{text}");
    }

    #[test]
    fn a_table_may_stand_in_a_file() {
        let graph = |points: &str| {
            format!(
                "graph Coil {{ table flux: A -> Wb = {points}; 1 wire: electrical; R coil(i) = flux(i) / (1 s); I core = 2; wire -> coil; wire -> core; }}"
            )
        };
        let of_file =
            compiled(&[("table.bond", &graph("\"flux.csv\"")), ("flux.csv", "current [mA],flux\n0,0\n500,0.1\n")]);
        let own = compiled(&[("points.bond", &graph("[[0 mA, 0], [500 mA, 0.1]]"))]);
        // Rust builds anew where the points change.
        assert_eq!(of_file.matches("include_bytes").count(), 2, "{of_file}");
        let after = |items: &str| {
            items.split("include_bytes").last().and_then(|rest| rest.split_once(';')).map(|(_, items)| items.to_owned())
        };
        assert!(after(&of_file).is_some() && after(&of_file) == after(&own), "{of_file}");
        let missing = compiled(&[("none.bond", &graph("\"none.csv\""))]);
        assert!(missing.contains("none.bond:1:36: [BG0901] cannot read `none.csv`"), "{missing}");
    }

    #[test]
    fn a_file_uses_others() {
        let graph = "graph Driven { part shaft: Shaft; Se f = 1; 1 j: rotation; f -> j -> shaft.end; }";
        let driven = &format!("use \"parts/shaft.bond\"; {graph}");
        let shaft = "pub part Shaft { port end: rotation; I wheel = 2; end -> wheel; }";
        let items = compiled(&[("driven.bond", driven), ("parts/shaft.bond", shaft)]);
        assert!(items.contains("struct Driven"), "{items}");
        // Rust builds anew where either file changes; the part is no item of this call.
        assert_eq!(items.matches("include_bytes").count(), 2, "{items}");
        assert!(!items.contains("macro_rules"), "{items}");
        let items = compiled(&[("faulty.bond", driven), ("parts/shaft.bond", &shaft.replace("= 2", "= two"))]);
        assert!(items.contains("parts/shaft.bond:1:48: [BG0303]"), "{items}");
        let items = compiled(&[("alone.bond", driven)]);
        assert!(items.contains("alone.bond:1:5: [BG0901] cannot read `parts/shaft.bond`"), "{items}");
    }
}
