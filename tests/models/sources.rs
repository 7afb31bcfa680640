//! Flow sources, conductance laws, and one storage given by its stiffness and by its compliance.

use bg_model::bond_graph;

bond_graph! {
    /// A current source charges a capacitor beside a resistor whose law is a conductance: flow from effort.
    pub graph ChargedCapacitor {
        /// Current of the source.
        param current: A = 0.2;
        /// Resistance beside the capacitor.
        param resistance: Ohm = 50, above 0;
        /// Capacitance.
        param capacitance: F = 1e-3, above 0;
        Sf source = current;
        0 node: electrical;
        C capacitor = capacitance;
        R leak(effort u) = u / resistance;
        source -> node -> capacitor;
        node -> leak;
        observe { voltage: V = node.effort; leak_current: A = leak.flow; }
    }

    /// The same spring twice: by its stiffness and by its compliance. Each has its own mass.
    pub graph StiffnessAndCompliance {
        /// Mass of both oscillators.
        param mass: kg = 0.5, above 0;
        /// Stiffness of the first spring.
        param stiffness: N/m = 80, above 0;
        /// Compliance of the second spring.
        param compliance: m/N = 0.0125, above 0;
        1 first: translation;
        1 second: translation;
        I first_mass = mass;
        I second_mass = mass;
        C first_spring = stiffness start 0.1;
        C second_spring = compliance start 0.1;
        first -> first_mass;
        first -> first_spring;
        second -> second_mass;
        second -> second_spring;
        observe { first: m = first_spring.q; second: m = second_spring.q; }
    }
}
