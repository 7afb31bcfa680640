//! Primitives fitted to meshes have the mass, centre and moments that MuJoCo gives them.

use bg_import::{Format, import};

use super::kinds::{NO_CONTACTS, made};

/// A fitted shape on a hinge.
fn fitted(kind: &str, compiler: &str, mesh: &str, geom: &str) -> String {
    format!(
        "<mujoco><compiler {compiler}/><asset><mesh name='m' vertex='0 0 0 1 0 0 0.2 0.6 0 0.1 0.2 0.35' \
         face='0 2 1 0 1 3 0 3 2 1 2 3' {mesh}/></asset><worldbody><body name='b'><joint name='pin'/>\n\
         <geom type='{kind}' mesh='m' {geom}/></body></worldbody></mujoco>"
    )
}

/// The numbers of the clause that starts with a word.
fn clause(text: &str, word: &str) -> Vec<f64> {
    let line = text.lines().find(|line| line.trim_start().starts_with(word)).unwrap_or_else(|| panic!("{text}"));
    let rest = line.trim_start()[word.len()..].replace(['[', ']', ',', ';'], " ");
    rest.split_whitespace().map(|word| word.parse().expect("a number")).collect()
}

/// Type, `compiler`, `mesh`, `geom`; mass, centre, moments xx xy xz yy yz zz of the body in MuJoCo 4.0.0.
type Fact = (&'static str, &'static str, &'static str, &'static str, [f64; 10]);

#[test]
fn sizes_and_frames_are_mujocos() {
    let facts: [Fact; 14] = [
        (
            "sphere",
            "",
            "",
            "",
            [
                34.0259944,
                0.325000001,
                0.200000007,
                0.0874999985,
                0.549986837,
                1.95989764e-17,
                1.40261837e-17,
                0.549986837,
                -4.74395549e-18,
                0.549986837,
            ],
        ),
        (
            "sphere",
            "fitaabb='true'",
            "",
            "",
            [
                460.816109,
                0.562816583,
                0.194877377,
                0.0751474871,
                42.3201313,
                1.9700719e-15,
                6.47775316e-16,
                42.3201313,
                -1.07912105e-15,
                42.3201313,
            ],
        ),
        (
            "capsule",
            "",
            "",
            "",
            [
                43.7385314,
                0.325000001,
                0.200000007,
                0.0874999985,
                0.555464519,
                0.389580132,
                0.190334052,
                1.84821492,
                -0.0529238639,
                1.93068411,
            ],
        ),
        (
            "capsule",
            "fitaabb='true'",
            "",
            "",
            [
                228.411636,
                0.562816583,
                0.194877377,
                0.0751474871,
                10.4478549,
                1.77550614,
                0.867444846,
                16.3395472,
                -0.241199787,
                16.7153995,
            ],
        ),
        (
            "cylinder",
            "",
            "",
            "",
            [
                40.6867474,
                0.325000001,
                0.200000007,
                0.0874999985,
                0.516323377,
                0.294016702,
                0.143645391,
                1.49196401,
                -0.0399417184,
                1.55420364,
            ],
        ),
        (
            "cylinder",
            "fitaabb='true'",
            "",
            "",
            [
                291.516751,
                0.562816583,
                0.194877377,
                0.0751474871,
                15.4467367,
                3.87060977,
                1.89103289,
                28.2906471,
                -0.525816405,
                29.1100064,
            ],
        ),
        (
            "ellipsoid",
            "",
            "",
            "",
            [
                25.5514062,
                0.325000001,
                0.200000007,
                0.0874999985,
                0.2543962,
                0.0919850629,
                0.0603651964,
                0.551431283,
                1.1320922e-09,
                0.664975361,
            ],
        ),
        (
            "ellipsoid",
            "fitaabb='true'",
            "",
            "",
            [
                119.887206,
                0.562816583,
                0.194877377,
                0.0751474871,
                3.52375107,
                0.837731657,
                0.630162815,
                6.18618101,
                0.0651353385,
                7.71060472,
            ],
        ),
        (
            "box",
            "",
            "",
            "",
            [
                48.7995913,
                0.325000001,
                0.200000007,
                0.0874999985,
                0.809768254,
                0.292797549,
                0.192148388,
                1.75526029,
                3.60356142e-09,
                2.11668231,
            ],
        ),
        (
            "box",
            "fitaabb='true'",
            "",
            "",
            [
                228.967698,
                0.562816583,
                0.194877377,
                0.0751474871,
                11.216448,
                2.66658268,
                2.00587054,
                19.6912257,
                0.207332222,
                24.5436171,
            ],
        ),
        (
            "box",
            "",
            "inertia='shell'",
            "",
            [
                103.134302,
                0.363895108,
                0.197422851,
                0.0764829135,
                2.83910512,
                1.02100497,
                0.632624694,
                6.01414385,
                0.00292827806,
                7.29904113,
            ],
        ),
        (
            "box",
            "",
            "",
            "shellinertia='true'",
            [
                879.110296,
                0.325000001,
                0.200000007,
                0.0874999985,
                24.3428594,
                6.47826492,
                4.39326957,
                45.1868105,
                0.114963761,
                54.0488837,
            ],
        ),
        (
            "capsule",
            "",
            "",
            "fitscale='0.5' pos='1 2 3' euler='30 40 50'",
            [
                5.46731642,
                1.09891035,
                2.31132987,
                3.21580479,
                0.0470036519,
                -0.0207925392,
                0.00678885243,
                0.0305631591,
                0.00998408787,
                0.0578820498,
            ],
        ),
        (
            "box",
            "",
            "scale='2 1 1' refpos='0.1 0 0' refquat='1 1 0 0'",
            "mass='3'",
            [
                3.0,
                0.450000002,
                0.0874999985,
                -0.200000007,
                0.0497812523,
                0.0236249988,
                -0.036,
                0.412500004,
                7.89229186e-09,
                0.390281247,
            ],
        ),
    ];
    for (kind, compiler, mesh, geom, wanted) in facts {
        let imported = made(&fitted(kind, compiler, mesh, geom));
        assert_eq!(imported.notes, [""; 0]);
        let tensor = clause(&imported.text, "inertia");
        let tensor = match tensor[..] {
            [xx, yy, zz] => [xx, 0.0, 0.0, yy, 0.0, zz],
            _ => [0, 1, 2, 4, 5, 8].map(|k| tensor[k]),
        };
        let found = [clause(&imported.text, "mass"), clause(&imported.text, "center"), tensor.to_vec()].concat();
        // MuJoCo stores vertices in single precision.
        let scales = [wanted[0], 1.0, wanted[4].max(wanted[7]).max(wanted[9])].map(|size: f64| 1e-6 * size);
        for (k, (found, wanted)) in found.iter().zip(wanted).enumerate() {
            let allowed = scales[[0, 1, 1, 1, 2, 2, 2, 2, 2, 2][k]];
            assert!((found - wanted).abs() < allowed, "{kind} {compiler} {mesh} {geom}, {k}: {found}, not {wanted}");
        }
    }
}

#[test]
fn what_is_not_clear_of_a_fitted_shape_is_told() {
    let pyramid = |kind: &str, compiler: &str, top: &str| {
        fitted(kind, compiler, "", "").replace("1 0 0 0.2 0.6 0 0.1 0.2 0.35", &format!("1 0 0 0 1 0 {top}"))
    };
    let note = |kind: &str| {
        format!(
            "line 2: shape is a {kind} fitted to a mesh with equal moments of inertia: MuJoCo may turn it otherwise."
        )
    };
    // A tetrahedron with three equal edges at one corner: two equal moments, the smaller ones.
    let flat = "0 0 1";
    assert_eq!(made(&pyramid("cylinder", "", flat)).notes, [note("cylinder")]);
    assert_eq!(made(&pyramid("box", "", flat)).notes, [""; 0], "all boxes that fit have the same moments");
    assert_eq!(made(&pyramid("box", "fitaabb='true'", flat)).notes, [note("box")]);
    assert_eq!(made(&pyramid("cylinder", "", "0 0 9")).notes, [""; 0], "it has a long side");
    let refused = [
        (
            "fromto='0 0 0 1 0 0' size='1'",
            "`fromto` of <geom> is \"0 0 0 1 0 0\": it must be left out where a mesh is given",
        ),
        ("fitscale='0'", "`fitscale` of <geom> is \"0\": it must be above 0"),
    ];
    for (geom, message) in refused {
        let text = fitted("capsule", "", "", geom);
        let fault = import(Format::Mjcf, "r.xml", &text, NO_CONTACTS).expect_err("MuJoCo refuses it");
        assert_eq!(fault.to_string(), format!("line 2: {message}"));
    }
}
