//! A mass that a force pushes and another one brakes: a model with inputs as a Python module.

use bg_model::bond_graph;

bond_graph! {
    /// A mass under two forces.
    pub graph Driven {
        /// What is moved.
        param mass: kg = 2, above 0;
        /// Pushes the mass.
        input push: N;
        /// Brakes it.
        input brake: N;
        1 slide: translation;
        I body = mass;
        Se forward = push;
        Se backward = -brake;
        forward -> slide -> body; backward -> slide;
        observe { speed: m/s = slide.flow; }
    }
}

bg_python::python_module!(_driven, bg_workbench::Program::of::<Driven>);
