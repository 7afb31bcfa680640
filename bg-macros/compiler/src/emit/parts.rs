//! Parts for other macro calls, of this crate and of others.
//!
//! In: the parts of a call. Out: for each public one a `macro_rules!` that hands its tokens to whoever asks,
//! re-exported under the part's own name, so that its path is that of an item. Whoever meets a path asks: it calls that
//! macro with its own tokens, and the macro calls `bond_graph!` with the part in front of them. Method: tokens carried
//! by callbacks, as in the crate `macro_magic` (Sam Johnson, 2023).
//!
//! All exported macros of a crate stand in one place, so that the name of each has the part's place in the source.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::items::identifier;
use crate::source::ast::{Foreign, Part, PartPath, Source, used_parts};
use crate::source::visibility::Visibility;

/// The macros of all parts that can be used elsewhere.
#[must_use]
pub fn parts(source: &Source) -> TokenStream {
    source.parts.iter().filter_map(|part| exported(source, part)).collect()
}

/// The call of a part's macro that answers with this call and the part in front of it.
#[must_use]
pub fn question(part: &PartPath, call: &TokenStream) -> TokenStream {
    let path = &part.written.0;
    quote!(#path! { { #path } #call })
}

fn exported(source: &Source, part: &Part) -> Option<TokenStream> {
    let visibility = &part.visibility;
    let export = match visibility {
        Visibility::Private => return None,
        Visibility::Public(_) => Some(quote!(#[macro_export])),
        Visibility::Within(..) => None,
    };
    let (name, carrier, docs) = (identifier(&part.name.text), carrier(part), &part.docs);
    let answer = answer(source, part);
    Some(quote! {
        #[doc(hidden)]
        #export
        #[allow(non_local_definitions, unused_macros)]
        macro_rules! #carrier {
            ({ $($path:tt)* } $($call:tt)*) => {
                ::bg_model::bond_graph! { @from { $($path)* } { #answer } $($call)* }
            };
        }
        #[doc = #docs]
        #[doc(inline)]
        #[allow(unused_imports)]
        #visibility use #carrier as #name;
    })
}

/// The name of the macro: no other one of the crate has it, unless two files have the same part at the same place.
fn carrier(part: &Part) -> Ident {
    let start = part.name.span.start();
    // FNV-1a over the file and the tokens.
    let text = format!("{:?} {}", part.name.span.local_file(), part.written.0);
    let hash = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    format_ident!("__bond_graph_part_{}_{}_{}_{hash:016x}", part.name.text, start.line, start.column)
}

/// A part with all that it uses: the part first, then those of its call, then those of other calls.
fn answer(source: &Source, part: &Part) -> TokenStream {
    let mut needed = vec![part];
    let mut next = 0;
    while let Some(part) = needed.get(next) {
        for inside in used_parts(&part.items).into_iter().filter_map(|path| named(source, path)) {
            if needed.iter().all(|known| known.name.text != inside.name.text) {
                needed.push(inside);
            }
        }
        next += 1;
    }
    let is_used = |foreign: &&Foreign| {
        needed.iter().any(|part| used_parts(&part.items).iter().any(|path| path.name.text == foreign.path.text))
    };
    let foreign = source.foreign.iter().filter(is_used);
    needed.iter().map(|part| part.written.0.clone()).chain(foreign.map(repeated)).collect()
}

fn named<'s>(source: &'s Source, path: &PartPath) -> Option<&'s Part> {
    source.parts.iter().find(|part| part.name.text == path.name.text)
}

/// What another call has answered, to be handed on.
fn repeated(foreign: &Foreign) -> TokenStream {
    let path = &foreign.written.0;
    let answer = foreign.source.parts.first().map(|part| answer(&foreign.source, part));
    quote!(@from { #path } { #answer })
}
