//! A fault inside of a part that is used three times: told once, at the part's token, with a use.

use bg_model::bond_graph;
use bg_model::system::Model;

bond_graph! {
    part Wheel {
        param mass: kg = 3, above 0;
        param radius: m = 0.3, above 0;
        port axle: rotation;
        I inertia = mass * radius;
        axle -> inertia;
    }
    graph Cart {
        part wheel[3]: Wheel { mass = 5; }
        Se push = 1;
        1 shaft: rotation;
        push -> shaft;
        for i in 0..3 {
            shaft -> wheel[i].axle;
        }
    }
}

fn main() {
    let cart = Cart::new(CartParameters { wheel_0_radius: 0.2, ..CartParameters::default() }).expect("in range");
    println!("{}", cart.start().is_ok());
}
