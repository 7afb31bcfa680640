//! The look of a mechanism as a table of the generated model's description.
//!
//! In: a [`Drawing`]. Out: a `Drawing` literal.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::items::number;
use crate::program::Tape;
use crate::source::drawing::{self, Joint, Point, Shape, Solid};
use crate::tables::{Body, Drawing, Place};

/// The `Drawing` literal.
pub(super) fn drawing(Drawing { bodies, ground, gravity, joints, bonds, tape }: &Drawing) -> TokenStream {
    let (bodies, joints) = (bodies.iter().map(body_info), joints.iter().map(joint));
    let (ground, gravity, tape) = (points(ground), optional(gravity.as_ref()), words(tape));
    let bonds = bonds.iter().map(|places| places.map(|of| place(&of))).map(|[e, f]| quote!([#e, #f]));
    quote! {
        ::bg_model::drawing::Drawing {
            bodies: &[#(#bodies,)*], ground: #ground, gravity: #gravity, joints: &[#(#joints,)*],
            bonds: &[#(#bonds,)*], tape: #tape,
        }
    }
}

fn place(of: &Place) -> TokenStream {
    let Some(place) = of.map(Literal::usize_unsuffixed) else { return quote!(None) };
    quote!(Some(#place))
}

fn body_info(Body { look, states }: &Body) -> TokenStream {
    let drawing::Body { name, position, orientation, solids, points: named } = look;
    let (position, orientation) = (place(position), place(orientation));
    let (solids, points) = (solids.iter().map(solid), points(named));
    let states = states.iter().copied().map(Literal::usize_unsuffixed);
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
        Shape::Cuboid(edges) => {
            let edges = place(edges);
            quote!(Cuboid(#edges))
        }
        Shape::Cylinder { radius, length, axis } => {
            let (radius, length) = (place(radius), place(length));
            let axis = Literal::usize_unsuffixed(*axis as usize);
            quote!(Cylinder { radius: #radius, length: #length, axis: #axis })
        }
        Shape::Sphere(radius) => {
            let radius = place(radius);
            quote!(Sphere(#radius))
        }
    };
    let (center, turned) = (place(center), optional(turned.as_ref()));
    quote! {
        ::bg_model::drawing::Solid { shape: ::bg_model::drawing::Shape::#shape, center: #center, turned: #turned }
    }
}

fn points(of: &[Point<Place>]) -> TokenStream {
    let points = of.iter().map(|Point { name, place: at }| {
        let at = place(at);
        quote!(::bg_model::drawing::Point { name: #name, place: #at })
    });
    quote!(&[#(#points,)*])
}

fn joint(joint: &Joint<Place>) -> TokenStream {
    let Joint { name, word, ends, places, force, moment } = joint;
    let (places, force) = (places.iter().map(place), place(force));
    let moment = optional(moment.as_ref());
    quote! {
        ::bg_model::drawing::Joint {
            name: #name, word: #word, ends: [#(#ends),*], places: [#(#places),*], force: #force, moment: #moment,
        }
    }
}

fn optional(place: Option<&Place>) -> TokenStream {
    place.map_or_else(
        || quote!(None),
        |of| {
            let of = self::place(of);
            quote!(Some(#of))
        },
    )
}

fn words(tape: &Tape) -> TokenStream {
    let words = tape.words.iter().map(|&word| Literal::u32_unsuffixed(word));
    let results = tape.results.iter().map(|&step| Literal::u32_unsuffixed(step));
    let numbers = tape.numbers.iter().map(|&value| number(value));
    quote! {
        ::bg_model::drawing::Tape { numbers: &[#(#numbers),*], words: &[#(#words),*], results: &[#(#results),*] }
    }
}
