//! The look of a mechanism as a table of the generated model's description.
//!
//! In: a [`Compiled`]. Out: a `Drawing` literal, with the places of its quantities on the model's tape.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::items::number;
use crate::expr::Symbol;
use crate::graph::drawing::{Body, Drawing, Joint, Point, Shape, Solid};
use crate::pipeline::Compiled;
use crate::program::Tape;
use crate::system::equations::{Quantity, StateEquations};

/// A place on the tape as a literal.
type Place = TokenStream;

/// The `Drawing` literal.
pub(super) fn drawing(model: &Compiled) -> TokenStream {
    let (shown, tape) = (&model.equations.shown, &model.programs.shown);
    let mut places = tape.places.iter().map(place);
    let mut next = || places.next().expect("a place for each quantity");
    let Drawing { bodies, ground, gravity, joints } = shown.drawing.map(&mut |_| next());
    let bonds: Vec<TokenStream> = shown.bonds.iter().map(|_| (next(), next())).map(|(e, f)| quote!([#e, #f])).collect();
    let bodies = bodies.iter().zip(&shown.drawing.bodies).map(|(body, quantities)| {
        let states = states(&model.equations, &[&quantities.position, &quantities.orientation]);
        body_info(body, &states)
    });
    let (ground, gravity, tape) = (points(&ground), optional(gravity.as_ref()), words(tape));
    let joints = joints.iter().map(joint);
    quote! {
        ::bg_model::drawing::Drawing {
            bodies: &[#(#bodies,)*], ground: #ground, gravity: #gravity, joints: &[#(#joints,)*],
            bonds: &[#(#bonds,)*], tape: #tape,
        }
    }
}

fn place(of: &Option<usize>) -> Place {
    let Some(place) = of.map(Literal::usize_unsuffixed) else { return quote!(None) };
    quote!(Some(#place))
}

/// The states that quantities depend on.
fn states(equations: &StateEquations, of: &[&Quantity]) -> Vec<Literal> {
    let ids: Vec<_> = of.iter().copied().flatten().flatten().copied().collect();
    let symbols = equations.pool.symbols(&ids).into_iter();
    symbols.filter_map(Symbol::as_state).map(Literal::usize_unsuffixed).collect()
}

fn body_info(body: &Body<Place>, states: &[Literal]) -> TokenStream {
    let Body { name, position, orientation, solids, points: named } = body;
    let (solids, points) = (solids.iter().map(solid), points(named));
    quote! {
        ::bg_model::drawing::Body {
            name: #name, position: #position, orientation: #orientation, states: &[#(#states),*],
            solids: &[#(#solids,)*], points: #points,
        }
    }
}

fn solid(solid: &Solid<Place>) -> TokenStream {
    let Solid { shape, center, turned } = solid;
    let shape = match shape {
        Shape::Cuboid(edges) => quote!(Cuboid(#edges)),
        Shape::Cylinder { radius, length, axis } => {
            let axis = Literal::usize_unsuffixed(*axis as usize);
            quote!(Cylinder { radius: #radius, length: #length, axis: #axis })
        }
        Shape::Sphere(radius) => quote!(Sphere(#radius)),
    };
    let turned = optional(turned.as_ref());
    quote! {
        ::bg_model::drawing::Solid { shape: ::bg_model::drawing::Shape::#shape, center: #center, turned: #turned }
    }
}

fn points(of: &[Point<Place>]) -> TokenStream {
    let points =
        of.iter().map(|Point { name, place }| quote!(::bg_model::drawing::Point { name: #name, place: #place }));
    quote!(&[#(#points,)*])
}

fn joint(joint: &Joint<Place>) -> TokenStream {
    let Joint { name, word, ends, places, force, moment } = joint;
    let moment = optional(moment.as_ref());
    quote! {
        ::bg_model::drawing::Joint {
            name: #name, word: #word, ends: [#(#ends),*], places: [#(#places),*], force: #force, moment: #moment,
        }
    }
}

fn optional(place: Option<&Place>) -> TokenStream {
    place.map_or_else(|| quote!(None), |place| quote!(Some(#place)))
}

fn words(tape: &Tape) -> TokenStream {
    let words = tape.words.iter().map(|&word| Literal::u32_unsuffixed(word));
    let results = tape.results.iter().map(|&step| Literal::u32_unsuffixed(step));
    let numbers = tape.numbers.iter().map(|&value| number(value));
    quote! {
        ::bg_model::drawing::Tape { numbers: &[#(#numbers),*], words: &[#(#words),*], results: &[#(#results),*] }
    }
}
