//! Models that would have structs of one name: each is told, and nothing of rustc's follows.

use bg_model::bond_graph;
use bg_model::system::Model;

bond_graph! {
    graph Slide {
        param mass: kg = 2;
        1 slide: translation;
        I m = mass;
        slide -> m;
        scene SlideParameters {}
    }
    graph Slide {
        param mass: kg = 3;
        1 slide: translation;
        I m = mass;
        slide -> m;
    }
}

fn main() {
    let slide = Slide::new(SlideParameters { mass: 3.0 }).expect("in range");
    println!("{}", slide.start().is_ok());
}
