//! `identify`: intervals beside what columns say of the noise.

use serde_json::Value;

use super::{folder, told, write};

const SWING: &str = "
graph Swing {
    param mass: kg = 2; param stiffness: N/m = 50;
    1 slide: translation; I body = mass start 0; C spring = stiffness start 0.1; slide -> body; slide -> spring;
    observe { x: m = spring.q; v: m/s = slide.flow; still: m = 0 * spring.q }
}";

#[test]
fn a_column_that_never_moves_makes_no_interval_narrower() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    // Normal noise by the sum of twelve even numbers (the generator MMIX of Knuth, vol. 2, 3.3.4).
    let mut state = 5_u64;
    let mut normal = || {
        let mut even = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..12).map(|_| even()).sum::<f64>()
    };
    let mut csv = "t,x,v,still\n".to_owned();
    for k in 0..=200 {
        let t = 0.01 * f64::from(k);
        let [x, v] = [0.1 * (5.0 * t).cos() + 1e-3 * normal(), -0.5 * (5.0 * t).sin() + 5e-3 * normal()];
        csv += &format!("{t},{x},{v},0\n");
    }
    write(&folder, "m.csv", &csv);
    let interval = |options: &str| {
        let line = format!("identify swing.bond m.csv --fit stiffness --set stiffness=51 --json {options}");
        let found: Value = serde_json::from_str(&told(folder.path(), &line)).expect("JSON");
        let ends = &found["parameters"][0]["interval"];
        let [lower, upper] = [0, 1].map(|end| ends[end].as_f64().expect("an end"));
        assert!(lower < 50.0 && 50.0 < upper, "{found}");
        upper - lower
    };
    let (all, moving) = (interval(""), interval("--output x,v"));
    assert!((all / moving - 1.0).abs() < 1e-6, "{all} {moving}");
    // The noise is 1 % of an amplitude in each column; x and v move by t / 20 of theirs for each N/m: with J'J the sum
    // over both columns of the squares of that in parts of the noise.
    let square = |k: i32| {
        let t = 0.01 * f64::from(k);
        let by = [-0.1 * t * (5.0 * t).sin() / 1e-3, (-0.5 * t * (5.0 * t).cos() - 0.1 * (5.0 * t).sin()) / 5e-3];
        // The frequency goes by 0.05 for each N/m.
        by.iter().map(|by| (0.05 * by).powi(2)).sum::<f64>()
    };
    let expected = 2.0 * 1.966 / (0..=200).map(square).sum::<f64>().sqrt();
    assert!((all / expected - 1.0).abs() < 0.1, "{all} {expected}");
}
