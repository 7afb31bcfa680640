//! Values that can be and values that cannot, by way of the language.

use super::Requirements;
use crate::fault::{Fault, Staged};
use crate::pipeline;
use crate::source::{scene, syntax};

fn compiled(statements: &str) -> Staged<Requirements> {
    let text = format!("graph G {{\n{statements}\n}}");
    let source = syntax::parse(text.parse().unwrap_or_else(|error| panic!("{error}\n{text}")))?;
    let mut last = Requirements::default();
    for variant in scene::variants(&source.graphs[0])? {
        last = pipeline::compile(&variant)?.equations.requirements.clone();
    }
    Ok(last)
}

fn body(clauses: &str) -> String {
    format!("body rod {{ {clauses} }}")
}

/// A law on a multibond junction with a mass.
fn multibond(element: &str) -> String {
    format!("1 j[3]: translation; I m = 2; {element}; j -> m; j -> a;")
}

fn scalar(element: &str) -> String {
    format!("1 j: translation; I m = 2; {element}; j -> m; j -> a;")
}

/// What is said of each, and the text that it is said at.
fn said(statements: &str) -> Vec<String> {
    let faults = compiled(statements).err().unwrap_or_default();
    faults.iter().map(|Fault { code, message, .. }| format!("{code} {message}")).collect()
}

fn accepted(statements: &str) {
    assert_eq!(said(statements), [""; 0], "{statements}");
}

fn refused(statements: &str, with: &str) {
    assert_eq!(said(statements), [with], "{statements}");
}

#[test]
fn tensors_that_no_body_can_have() {
    let inertia = |tensor: &str| body(&format!("mass 1; inertia {tensor};"));
    let of = |wanted: &str| format!("BG0702 the inertia of body `rod` {wanted}");
    let triangle = of("must have no principal moment larger than the other two together");
    refused(&inertia("[[1, 2, 0], [0, 2, 0], [0, 0, 3]]"), &of("must be symmetric"));
    refused(&inertia("[[1, 2, 0], [2, 1, 0], [0, 0, 1]]"), &of("must be positive definite"));
    refused(&inertia("[[0, 0, 0], [0, 1, 0], [0, 0, 1]]"), &of("must be positive definite"));
    refused(&inertia("[1, 1, 100]"), &triangle);
    refused(&inertia("rotation_x(0.7) * diagonal([1, 1, 2.1]) * rotation_x(-0.7)"), &triangle);
    refused(
        &inertia("[1, -1, 1]"),
        "BG0701 the y component of the inertia of body `rod` is -1 kg*m^2; it must be above 0",
    );
    // A plate, with moments of three digits; a slender rod, turned.
    accepted(&inertia("[1.33, 1.33, 2.67]"));
    accepted(&inertia("[0.1, 0.2, 0.3]"));
    accepted(&inertia("rotation_z(0.7) * diagonal([1e-9, 1, 1]) * rotation_z(-0.7)"));
}

#[test]
fn matrices_of_storages_and_resistances() {
    refused(
        "1 j[3]: translation; I b = [[2, 1, 0], [0, 2, 0], [0, 0, 2]]; j -> b;",
        "BG0702 the inertia of I `b` must be symmetric",
    );
    let unit = "let k: N/m = 1;";
    let stiffness = |matrix: &str| format!("{unit}{}", multibond(&format!("C a = k * {matrix}")));
    let of = |wanted: &str| format!("BG0702 the stiffness of C `a` {wanted}");
    refused(&stiffness("[[2, 1, 0], [0, 2, 0], [0, 0, 2]]"), &of("must be symmetric"));
    refused(&stiffness("[[1, 2, 0], [2, 1, 0], [0, 0, 1]]"), &of("must not be negative in any direction"));
    refused(&stiffness("[[0, 0, 0], [0, 0, 1], [0, 1, 0]]"), &of("must not be negative in any direction"));
    // Stiff in one direction only, as of a spring along a line; none at all.
    accepted(&stiffness("outer([0.6, 0, 0.8], [0.6, 0, 0.8])"));
    accepted(&stiffness("outer([1, 1, 1], [1, 1, 1])"));
    accepted(&stiffness("diagonal([0, 0, 0])"));
    let resistance = |matrix: &str| multibond(&format!("R a = {matrix}"));
    let gives = "BG0702 the resistance of R `a` must not give power in any direction";
    refused(&resistance("[[-1, 0, 0], [0, 1, 0], [0, 0, 1]]"), gives);
    refused(&resistance("[[1, 3, 0], [0, 1, 0], [0, 0, 1]]"), gives);
    // A gyrator takes no power, whatever its size.
    accepted(&resistance("[[0, 3, 0], [-3, 0, 1], [0, -1, 0]]"));
    accepted(&resistance("[[1, 3, 0], [-3, 1, 0], [0, 0, 0]]"));
}

#[test]
fn orientations_that_are_none() {
    let start = |matrix: &str| body(&format!("sphere radius 1; density 1; start turned {matrix};"));
    let part = |matrix: &str| body(&format!("sphere radius 1; cuboid [1, 2, 3] turned {matrix}; density 1;"));
    let columns = "must be a rotation: its columns are not perpendicular to each other and of length 1";
    let of_start = |wanted: &str| format!("BG0703 the start orientation of body `rod` {wanted}");
    refused(&start("[[2, 0, 0], [0, 2, 0], [0, 0, 2]]"), &of_start(columns));
    refused(&start("[[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]"), &of_start(columns));
    refused(&start("diagonal([1, 1, -1])"), &of_start("must be a rotation, not a mirror image"));
    refused(&start("2 * rotation_x(0.3)"), &of_start(columns));
    refused(
        &part("[[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]"),
        &format!("BG0703 the orientation of part 2 of body `rod` {columns}"),
    );
    refused(
        "1 j[3]: rotation; I m = 1; orientation R of j start diagonal([1, 2, 1]); j -> m;",
        &format!("BG0703 the start of orientation `R` {columns}"),
    );
    accepted(&start("rotation_x(0.3) * transpose(rotation_z(guess(0.1)))"));
    accepted(&start("[[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]]"));
    accepted(&part("[[0.866025, -0.5, 0], [0.5, 0.866025, 0], [0, 0, 1]]"));
}

#[test]
fn numbers_that_no_physics_allows() {
    let above = "it must be above 0";
    let sphere = |rest: &str| body(&format!("sphere radius 1 density 1; {rest}"));
    refused(&body("mass 0; inertia [1, 1, 1];"), &format!("BG0701 the mass of body `rod` is 0 kg; {above}"));
    refused(&body("mass 2 - 3; inertia [1, 1, 1];"), &format!("BG0701 the mass of body `rod` is -1 kg; {above}"));
    refused(&body("sphere radius 1 density 0;"), &format!("BG0701 the mass of body `rod` is 0 kg; {above}"));
    refused(
        &sphere("cuboid [1, 1, -1] density 1;"),
        "BG0701 the z component of the edges of part 2 of body `rod` is -1 m; it must not be negative",
    );
    refused(
        &body("cylinder radius -1 length 1 along x density 1;"),
        "BG0701 the radius of part 1 of body `rod` is -1 m; it must not be negative",
    );
    refused(
        &sphere("sphere radius 1 density -1;"),
        "BG0701 the density of part 2 of body `rod` is -1 kg/m^3; it must not be negative",
    );
    // A solid without mass beside one that has some.
    accepted(&sphere("sphere radius 1 density 0; cuboid [1, 1, 0] density 5;"));
    let joint = |clauses: &str| format!("{} joint pin: spherical (ground -> rod) {{ {clauses} }}", sphere(""));
    refused(
        &joint("stiffness -1e6; damping 1;"),
        "BG0701 the stiffness of joint `pin` is -1000000 N/m; it must not be negative",
    );
    refused(
        &joint("stiffness [1, 2, -3];"),
        "BG0701 the z component of the stiffness of joint `pin` is -3 N/m; it must not be negative",
    );
    refused(
        &joint("stiffness 1; damping -(1 + 1);"),
        "BG0701 the damping of joint `pin` is -2 N*s/m; it must not be negative",
    );
    accepted(&joint("stiffness 0; damping 0;"));
    accepted(&joint("rigid; stiffness -1;"));
    let spring = |clauses: &str| format!("{} spring s (ground -> rod) {{ {clauses} }}", sphere("start at [1, 0, 0];"));
    refused(&spring("stiffness -1;"), "BG0701 the stiffness of spring `s` is -1 N/m; it must not be negative");
    refused(
        &spring("stiffness 1; damping -1;"),
        "BG0701 the damping of spring `s` is -1 N*s/m; it must not be negative",
    );
    refused(&scalar("R a = -3"), "BG0701 the resistance of R `a` is -3 N*s/m; it must not be negative");
    refused(
        &scalar("let r = 2 - 3; R a = 2 * r"),
        "BG0701 the resistance of R `a` is -2 N*s/m; it must not be negative",
    );
    refused(
        "1 j: translation; I m = 0; R a = 1; j -> m; j -> a;",
        "BG0701 the inertia of I `m` is 0 kg; it must be above 0",
    );
    refused(
        "let k: N/m = -1; 1 j: translation; I m = 1; C a = k; j -> m; j -> a;",
        "BG0701 the stiffness of C `a` is -1 N/m; it must not be negative",
    );
    refused(
        "let c: m/N = 0; 1 j: translation; I m = 1; C a = c; j -> m; j -> a;",
        "BG0701 the compliance of C `a` is 0 s^2/kg; it must be above 0",
    );
    accepted(&scalar("R a = 0"));
    // The flow of this one follows from its effort.
    let divider = |value: &str| format!("Se e = 1; 0 j: translation; R a = {value}; e -> j -> a;");
    refused(
        &divider("0"),
        "BG0701 the resistance of R `a` is 0 N*s/m; it must be above 0, since its flow follows from its effort",
    );
    accepted(&divider("1"));
    // An R that gives power on purpose.
    accepted(&scalar("R a(f) = -3 * f"));
    refused(
        "Se e = 1; 0 j: hydraulic; R a(effort p) = 1e-8 * root(p, 0); e -> j -> a;",
        "BG0701 the laminar range of `root` is 0; it must be above 0",
    );
}

#[test]
fn what_is_proved_needs_no_check_and_the_rest_gets_one() {
    let left = |statements: &str| compiled(statements).unwrap_or_else(|faults| panic!("{faults:?}")).list.len();
    let with = |range: &str, clauses: &str| format!("param p: m = 1{range}; {}", body(clauses));
    let cuboid = "cuboid [p, 0.1, 0.1]; density 1;";
    assert_eq!(left(&with(", above 0", cuboid)), 0);
    // Its edge and the mass.
    assert_eq!(left(&with(", at least 0", cuboid)), 1);
    assert_eq!(left(&with("", cuboid)), 2);
    assert_eq!(left(&with(", above 0", "cuboid [p - 0.5, 0.1, 0.1]; density 1;")), 2);
    assert_eq!(left(&with("", "sphere radius 1; density 1; start turned rotation_x(p / 1) * rotation_y(2);")), 0);
    assert_eq!(left("param k: N/m = 1; 1 j: translation; I m = 1; C a = k; j -> m; j -> a;"), 1);
    // What is not of parameters alone is not looked at.
    assert_eq!(
        left("1 j: translation; I m = 1; let r: N*s/m = 1; let T: s = 1; MR a = r * (1 - t / T); j -> m; j -> a;"),
        0
    );
}

#[test]
fn a_scene_decides_what_it_does_not_tune() {
    let scene = |tune: &str| {
        format!(
            "param k: N/m = -1; param m: kg = 1, above 0; 1 j: translation; I b = m; C a = k; j -> b; j -> a;\n\
             observe {{ j.flow }} scene A {{ tune {{ {tune} }} }}"
        )
    };
    refused(&scene("m"), "BG0701 the stiffness of C `a` is -1 N/m; it must not be negative");
    let requirements = compiled(&scene("k")).unwrap();
    assert_eq!(requirements.list.len(), 1);
    // The parameter has another index in the scene.
    let symbols = requirements.pool.symbols(&[requirements.list[0].value]);
    assert_eq!(symbols.into_iter().collect::<Vec<_>>(), [crate::expr::Symbol::Parameter(0)]);
}

#[test]
fn a_fault_is_at_the_users_token() {
    let text = "graph G {\nbody rod {\nmass\n-1\n;\ninertia [1, 1, 1];\n}\n}";
    let source = syntax::parse(text.parse().unwrap()).unwrap();
    let faults = pipeline::derive(&source.graphs[0]).unwrap_err();
    assert_eq!(faults.iter().map(|fault| fault.span.start().line).collect::<Vec<_>>(), [4]);
}
