//! Numbers side by side of a model that is not compiled for them.
//!
//! In: a model for each run, or for each few slopes. Out: what steps side by side ask, put together of what each of
//! these answers by itself. The same bits, in more time; compiled once, here.

use std::ops::Range;
use std::rc::Rc;

use super::{Abreast, Machine, Rates};
use crate::model::holding::Held;
use crate::model::scalar::lanes::{Lanes, Vector, at, put};
use crate::model::scalar::slopes::{Slopes, WIDTH};
use crate::model::scalar::{Gradient, GradientIn};

/// The model of each of several runs side by side.
pub struct RunByRun(pub Vec<Rc<dyn Machine>>);

impl RunByRun {
    /// Any of the models, for what all have alike.
    fn first(&self) -> &dyn Machine {
        &*self.0[0]
    }

    /// Writes what `of` writes for each run.
    fn each<V: Vector>(
        &self,
        (t, x, negative): (Lanes<V>, &[Lanes<V>], &[V::Mask]),
        to: &mut [Lanes<V>],
        of: impl Fn(&dyn Machine, (f64, &[f64], &[bool]), &mut [f64]),
    ) {
        for (place, model) in self.0.iter().enumerate() {
            let negative: Vec<bool> = negative.iter().map(|&negative| V::bits(negative) >> place & 1 == 1).collect();
            let mut own = at(place, to);
            of(&**model, (t.get(place), &at(place, x), &negative), &mut own);
            put(place, to, &own);
        }
    }
}

impl<V: Vector> Abreast<V> for RunByRun {
    fn states(&self) -> usize {
        self.first().states()
    }

    fn switches(&self) -> usize {
        self.first().switches()
    }

    fn rate(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], dx: &mut [Lanes<V>]) {
        self.each((t, x, negative), dx, |model, (t, x, negative), dx| model.rate(t, x, negative, dx));
    }

    fn guards(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], guards: &mut [Lanes<V>]) {
        self.each((t, x, negative), guards, |model, (t, x, negative), guards| model.guards(t, x, negative, guards));
    }

    fn project(&self, t: Lanes<V>, negative: &[V::Mask], x: &mut [Lanes<V>]) {
        self.each((t, &[], negative), x, |model, (t, _, negative), x| model.project(t, negative, x));
    }

    fn second(&self) -> Range<usize> {
        self.first().second()
    }

    fn second_derivatives(&self, x: &[Lanes<V>], dx: &mut [Lanes<V>]) {
        self.each((x[0], x, &[]), dx, |model, (_, x, _), dx| model.second_derivatives(x, dx));
    }

    fn forces(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], dx: &mut [Lanes<V>]) {
        self.each((t, x, negative), dx, |model, (t, x, negative), dx| model.forces(t, x, negative, dx));
    }

    fn held(&self) -> Option<Held> {
        self.first().held()
    }

    fn kept(&self) -> &[f64] {
        self.first().kept()
    }

    fn is_hold_inlined(&self) -> bool {
        true
    }

    fn hold(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], entries: &mut [Lanes<V>]) {
        self.each((t, x, negative), entries, |model, (t, x, negative), entries| model.hold(t, x, negative, entries));
    }
}

/// The same model for each few slopes of several side by side.
pub struct EachAlone(pub Vec<Rc<dyn Machine<Gradient>>>);

impl EachAlone {
    /// Writes what `of` writes for the slopes of each model into the places of these in `to`, of states `x`.
    fn each<V: Slopes>(
        &self,
        x: &[GradientIn<V>],
        to: &mut [GradientIn<V>],
        of: impl Fn(&dyn Machine<Gradient>, &[Gradient], &mut [Gradient]),
    ) {
        let few = |number: &GradientIn<V>, model: usize| {
            let slopes = std::array::from_fn(|place| number.slopes().as_ref()[WIDTH * model + place]);
            Gradient::new(number.value, slopes)
        };
        let each: Vec<Vec<Gradient>> = (0..self.0.len())
            .map(|model| {
                let own: Vec<Gradient> = x.iter().map(|number| few(number, model)).collect();
                let mut result = own.clone();
                of(&*self.0[model], &own, &mut result);
                result
            })
            .collect();
        for (place, to) in to.iter_mut().enumerate() {
            let numbers: Vec<Gradient> = each.iter().map(|numbers| numbers[place]).collect();
            *to = GradientIn::joined(&numbers);
        }
    }
}

impl<V: Slopes> Rates<V> for EachAlone {
    fn rate(&self, t: f64, x: &[GradientIn<V>], negative: &[bool], dx: &mut [GradientIn<V>]) {
        self.each(x, dx, |model, x, dx| model.rate(Gradient::new(t, [0.0; WIDTH]), x, negative, dx));
    }

    fn project(&self, t: f64, negative: &[bool], x: &mut [GradientIn<V>]) {
        let before = x.to_vec();
        self.each(&before, x, |model, _, x| model.project(Gradient::new(t, [0.0; WIDTH]), negative, x));
    }
}
