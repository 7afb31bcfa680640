//! A use of a part with a parameter that it does not have: what the graph promises is there.

use bg_model::bond_graph;
use bg_model::system::Model;

bond_graph! {
    part Wheel {
        param mass: kg = 3, above 0;
        port axle: translation;
        I inertia = mass;
        axle -> inertia;
    }
    graph Cart {
        part front: Wheel { mas = 5; }
        Se push = 1;
        push -> front.axle;
    }
}

fn main() {
    let cart = Cart::new(CartParameters { front_mass: 3.0 }).expect("in range");
    println!("{}", cart.start().is_ok());
}
