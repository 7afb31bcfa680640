//! Networks drawn at random, mechanical and electrical, with symmetries: a scene's outputs are those of the literal
//! model.
//!
//! Method: oscillators with parameters from a small set, so that many are alike, and start values from a small set, so
//! that many are zero or opposite; some come with a twin of either sign that is coupled likewise.

use std::fmt::Write;

use super::{Draw, attempt, word};
use crate::random::Random;

/// The words of a domain: of a junction, then units of mass, stiffness and resistance, and their like.
struct Words {
    domain: &'static str,
    units: [&'static str; 3],
}

const DOMAINS: [Words; 3] = [
    Words { domain: "translation", units: ["kg", "N/m", "N*s/m"] },
    Words { domain: "rotation", units: ["kg*m^2", "N*m/rad", "N*m*s/rad"] },
    Words { domain: "electrical", units: ["H", "F", "Ohm"] },
];

/// A graph's statements and the clauses of a scene.
fn network(draw: &mut Draw) -> (String, String) {
    let Words { domain, units: [inertia, stiffness, resistance] } = &DOMAINS[draw.below(3)];
    let mut text = format!(
        "param m1: {inertia} = 1.5; param m2: {inertia} = 1.5; param m3: {inertia} = 0.7;
         param k1: {stiffness} = 9; param k2: {stiffness} = 9; param k3: {stiffness} = 4;
         param r1: {resistance} = 0.5; param r2: {resistance} = 0.5; param r3: {resistance} = 1.2;
         input push: {};\n",
        match *domain {
            "translation" => "N",
            "rotation" => "N*m",
            _ => "V",
        }
    );
    let masses = 2 + draw.below(4);
    let mut drawn: Vec<[String; 4]> = Vec::new();
    for i in 0..masses {
        // A twin has the elements of the one before it, and its start values up to sign.
        let twin = i > 0 && draw.chance(3, 5);
        let [mass, spring, resistor, source] = if twin {
            drawn[i - 1].clone()
        } else {
            [
                draw.pick(&["m1", "m1", "m2", "m3"]).to_owned(),
                draw.pick(&["", "k1", "k1", "k2", "k3"]).to_owned(),
                draw.pick(&["", "", "r1", "r2", "r3", "law"]).to_owned(),
                draw.pick(&["", "", "", "push", "2", "force"]).to_owned(),
            ]
        };
        let (momentum, stretch) = (draw.pick(&["0", "0", "0.1", "-0.1"]), draw.pick(&["0", "0.2", "0.2", "-0.2"]));
        let _ = writeln!(text, "1 j{i}: {domain}; I i{i} = {mass} start {momentum}; j{i} -> i{i};");
        if !spring.is_empty() {
            let _ = writeln!(text, "C c{i} = {spring} start {stretch}; j{i} -> c{i};");
        }
        match resistor.as_str() {
            "" => {}
            "law" => {
                let _ = writeln!(text, "R res{i}(v) = if v < 0 {{ r1 * v }} else {{ r3 * v }}; j{i} -> res{i};");
            }
            linear => {
                let _ = writeln!(text, "R res{i} = {linear}; j{i} -> res{i};");
            }
        }
        match source.as_str() {
            "" => {}
            "push" => {
                let _ = writeln!(text, "Se s{i} = {}push; s{i} -> j{i};", draw.pick(&["", "-"]));
            }
            "force" => {
                let _ = writeln!(text, "MSe s{i} = {}3 * sin(2 * t); s{i} -> j{i};", draw.pick(&["", "-"]));
            }
            constant => {
                let _ = writeln!(text, "Se s{i} = {}{constant}; s{i} -> j{i};", draw.pick(&["", "-"]));
            }
        }
        drawn.push([mass, spring, resistor, source]);
    }
    let couplings = draw.below(masses);
    let (kind, resistor) = (draw.pick(&["k1", "k3"]), draw.pick(&["", "r1", "r3"]));
    for c in 0..couplings {
        let (i, j) = (draw.below(masses), draw.below(masses));
        if i == j {
            continue;
        }
        let _ = writeln!(
            text,
            "0 z{c}: {domain}; 1 d{c}: {domain}; C s{c}c = {kind}; j{i} -> z{c} -> j{j}; z{c} -> d{c} -> s{c}c;"
        );
        if !resistor.is_empty() {
            let _ = writeln!(text, "R s{c}r = {resistor}; d{c} -> s{c}r;");
        }
    }
    let mut watched = String::new();
    for i in 0..masses {
        if i == 0 || draw.chance(1, 2) {
            let _ = write!(watched, "f{i} = j{i}.flow; p{i} = i{i}.p;");
        }
        if draw.chance(1, 4) {
            let _ = write!(watched, "w{i} = integral(i{i}.power);");
        }
    }
    if draw.chance(1, 4) {
        watched
            .push_str("energy = stored_energy; lost = integral(dissipated_power); given = integral(supplied_power);");
    }
    let mut clauses = format!("observe {{ {watched} }}");
    let all = ["m1", "m2", "m3", "k1", "k2", "k3", "r1", "r2", "r3"];
    let tune = draw.below(4);
    if tune > 0 {
        // All, none, or one in four.
        let chosen: Vec<&str> = all.into_iter().filter(|_| tune > 1 && draw.chance(1, 4)).collect();
        let _ = write!(clauses, "tune {{ {} }}", chosen.join(", "));
    }
    (text, clauses)
}

/// How many states went in which way over all networks.
#[derive(Default, Debug)]
struct Tally {
    states: usize,
    constant: usize,
    equal: usize,
    opposite: usize,
    recovered: usize,
    unwatched: usize,
}

#[test]
fn reduced_networks_move_as_the_literal_ones() {
    let mut tally = Tally::default();
    let mut worst = 0.0_f64;
    let mut graphs = 0;
    for seed in 0..240 {
        let mut draw = Draw(Random::new(0x5eed_0000 + 7919 * seed));
        let (text, clauses) = network(&mut draw);
        let scene = match attempt(&text, &clauses) {
            Ok(scene) => scene,
            Err(faults) => panic!("seed {seed}: {}\n{text}", faults[0]),
        };
        let (difference, largest) = scene.difference(&mut draw);
        let shown = || format!("seed {seed}: {difference:e}\n{text}scene Reduced {{ {clauses} }}\n{}", scene.report);
        assert!(largest.is_finite() && largest < 1e6, "{}", shown());
        assert!(difference < 1e-11, "{}", shown());
        worst = worst.max(difference);
        graphs += 1;
        for (_, fate) in &scene.report.fates {
            let fate = word(fate);
            tally.states += 1;
            tally.constant += usize::from(fate.starts_with("constant"));
            tally.equal += usize::from(fate.starts_with("equal"));
            tally.opposite += usize::from(fate.starts_with("equal -"));
            tally.recovered += usize::from(fate.starts_with("recovered"));
            tally.unwatched += usize::from(fate == "unwatched");
        }
    }
    println!("{graphs} networks, largest difference {worst:e}, {tally:?}");
    // The draw is worth nothing unless every reduction has occurred, many times.
    assert!(
        tally.constant > 20 && tally.opposite > 20 && tally.equal > 60 && tally.recovered > 20 && tally.unwatched > 40,
        "{tally:?}"
    );
}
