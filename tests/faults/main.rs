//! Every fault of every stage once: its code, its place and its words, from a minimal source.
//!
//! `▸` stands in front of the token that the fault is to be at. The words are in `faults/catalogue.snap`.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use bg_compiler::fault::{Fault, Staged};
use bg_compiler::pipeline;
use bg_compiler::source::syntax;
use bg_compiler::source::syntax::files::{self, Gathered, Opened};

const MARK: char = '▸';

/// The statements of the graph, one line each; they begin in line 2.
const SYNTAX: [(&str, &str); 24] = [
    ("BG0101", "▸resitor R = 2;"),
    ("BG0102", "supply ▸=> shaft;"),
    ("BG0103", "I rotor = ▸inertia"),
    ("BG0104", "let area = w▸^2;"),
    ("BG0105", "param length: N▸.m = 1;"),
    ("BG0106", "let a = ▸if b < c { 1 };"),
    ("BG0107", "let a = b ▸< c;"),
    ("BG0108", "let a = if a < b ▸|| c < d { 1 } else { 2 };"),
    ("BG0109", "let a = if a ▸== b { 1 } else { 2 };"),
    ("BG0110", "C spring = k start 1 ▸start 2;"),
    ("BG0111", "joint j: ▸revolut z (a -> b);"),
    ("BG0112", "joint j: ▸revolute (a -> b);"),
    ("BG0113", "param ▸mass = 3;"),
    ("BG0114", "param mass: ▸kg;"),
    ("BG0115", "scene ▸a.b {}"),
    ("BG0116", "param ▸type: m = 1;"),
    ("BG0117", "let a = ▸2.5f64;"),
    ("BG0118", DEEP),
    ("BG0119", "1 shaft[▸2];"),
    ("BG0120", "▸/// A coil.\nI L = coil;"),
    ("BG0121", "▸#[cfg(test)] I L = coil;"),
    ("BG0124", "▸sample a: 1 = 2;"),
    ("BG0122", ""),
    ("BG0123", "▸use \"shaft.bond\";"),
];

/// More parentheses than the parser follows.
const DEEP: &str = "deep";

const MECHANISM: [(&str, &str); 18] = [
    (
        "BG0201",
        "body rod { sphere radius 1; density 1; }\njoint pin: fixed (ground -> ▸rodd) { stiffness 1; tilt stiffness 1; \
        }",
    ),
    (
        "BG0202",
        "body rod { sphere radius 1; density 1; point end = [0, 0, 0]; }\n\
         joint pin: spherical (ground -> ▸rod.nd) { stiffness 1; }",
    ),
    ("BG0203", "body rod { sphere radius 1; density 1; }\njoint ▸pin: spherical (ground -> rod);"),
    (
        "BG0204",
        "body rod { sphere radius 1; density 1; }\n\
         joint pin: spherical (ground -> rod) { stiffness 1; tilt damping ▸1; }",
    ),
    ("BG0205", "body ▸rod { density 1; }"),
    ("BG0206", "body ▸rod { sphere radius 1; density 1; mass 2; inertia [1, 1, 1]; }"),
    ("BG0207", "gravity [0, 0, 0];\n▸gravity [0, 0, 1];"),
    ("BG0208", "body rod { sphere radius 1; density 1; }\ndrive push on ▸rot torque = 1;"),
    ("BG0209", "body rod { sphere radius 1; density 1; }\ndrive push on ▸rod speed = 1 { stiffness 1; }"),
    (
        "BG0210",
        "body rod { sphere radius 1; density 1; point end = [0, 0, 0]; }\n\
         spring coil (rod -> ▸rod.end) { stiffness 1; }",
    ),
    (
        "BG0211",
        "body rod { sphere radius 1; density 1; }\n\
         joint ▸pin: universal x x (ground -> rod) { stiffness 1; tilt stiffness 1; }",
    ),
    ("BG0212", "body rod { sphere radius 1; density 1; }\ncontact ▸cut (ground -> rod along x) {}"),
    (
        "BG0213",
        "body rod { sphere radius 1; density 1; }\njoint pin: spherical (ground -> rod) { stiffness 1; }\n\
         friction seat on ▸pin { coulomb 1; }",
    ),
    ("BG0214", "1 j: translation; I m = 2; j -> m; stop end on j { at most 2; stiffness ▸1e4; restitution 0.5; }"),
    (
        "BG0231",
        "body ball { sphere radius 0.1; density 1; }\ncontact ▸c (ground plane y -> ball circle 0.1) { stiffness 1e5; \
        }",
    ),
    (
        "BG0232",
        "body ball { sphere radius 0.1; density 1; }\ncontact ▸c (ground line z -> ball circle 0.1) { stiffness 1e5; }",
    ),
    (
        "BG0233",
        "table lift: rad -> m = [[0, 1], [3, 2], [6, 1]], spline, periodic;\nbody ball { sphere radius 0.1; density 1; \
        }\n\
         contact c (ground profile ▸lit -> ball circle 0.1) { stiffness 1e5; }",
    ),
    (
        "BG0234",
        "table lift: rad -> m = [[0, 1], [3, 2], [6, 1]], periodic;\nbody ball { sphere radius 0.1; density 1; }\n\
         contact c (ground profile ▸lift -> ball circle 0.1) { stiffness 1e5; }",
    ),
];

const GRAPH: [(&str, &str); 45] = [
    ("BG0301", "param mass: ▸kgs = 1;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0302", "param m: kg = 1;\nSe f = 1; 1 j: translation; I ▸m = 2; f -> j -> m;"),
    ("BG0303", "param mass: kg = 1;\nSe f = 1; 1 j: translation; I m = ▸mas; f -> j -> m;"),
    ("BG0304", "Se f = ▸sine(t / 1); 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0305", "Se f = 1; 1 j: ▸rotational; I m = 2; f -> j -> m;"),
    ("BG0306", "Se f = ▸atan2(1); 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0307", "param mass: kg = 1;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m; j -> ▸mass;"),
    ("BG0308", "Se ▸f = 1; 1 j: translation; 1 k; I m = 2; f -> j -> m; f -> k;"),
    ("BG0309", "Se f = 1; 1 j: translation; TF ▸g = 2; I m = 2; f -> j -> m; j -> g;"),
    ("BG0310", "Se f = 1; 1 j: translation; 1 ▸k; I m = 2; f -> j -> m;"),
    ("BG0311", "Se f = 1; 1 j: translation; 1 k[3]; I m = 2; f -> j -> m; j -> ▸k;"),
    ("BG0313", "let sum = [1, 2, 3] ▸+ 1;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0314", "Se f = ▸[1, 2, 3]; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0315", "param mass: kg = 1;\nSe f = 1; 1 j: translation; I m = ▸mass.x; f -> j -> m;"),
    ("BG0316", "param a: m = 1; param b: s = 1;\nlet c = a ▸+ b;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0317", "let a = sin(▸t);\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0318", "param a: m = 1;\nlet c = ▸sqrt(sqrt(a));\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0319", "Se f = 1; 1 j; I m = 2; f -> ▸j -> m;"),
    ("BG0320", "param mass: m = 1;\nSe f = 1; 1 j: translation; I m = ▸mass; f -> j -> m;"),
    ("BG0321", "Se f = 1; 1 j: translation; I m = 2; C s = ▸3; f -> j -> m; j -> s;"),
    ("BG0322", "Se f = m.p ▸* 2; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0323", "input k: N/m;\nSe f = 1; 1 j: translation; I m = 2; C s = ▸k; f -> j -> m; j -> s;"),
    ("BG0312", "Se f = 1; 1 j: translation; I m = 2; f -> j -> m; j -> ▸j;"),
    ("BG0324", "let ▸a = 2 * a;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0327", "param ▸a: 1 = 2, above 3, below 1;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0334", "param ▸t: s = 2;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0335", "baumgarte -▸50;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0325", "position x of ▸j;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0326", "Se f = 1; 1 j: translation; I m = 2; R ▸r = 3 start 1; f -> j -> m; j -> r;"),
    ("BG0328", "param a: 1 = ▸2, above 3;\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0329", "param b: 1 = ▸sqrt(2);\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0330", "Se f = ▸guess(1); 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0331", "MSe f = ▸integral(m.power); 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0336", "MSe f = ▸unwrapped(m.p, m.p, 0); 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0337", "Se f = 1; 1 j: translation; I m = ▸j; f -> j -> m;"),
    ("BG0338", "param m: kg = 1; Se f = 3 N/▸m; 1 j: translation; I a = m; f -> j -> a;"),
    (
        "BG0339",
        "table c: m -> N = [[0, 1], [▸0, 2], [1, 3]]; 1 j: translation; I m = 2; C k(q) = c(q); j -> m; j -> k;",
    ),
    ("BG0340", "table c: m -> N = [[0, 1], [1, 2]]; 1 j: translation; I m = 2; C k(q) = ▸c * q; j -> m; j -> k;"),
    (
        "BG0341",
        "table ▸c: m, V -> N = [[0, 1], [0, 1, 2], [1, 2, 3]], periodic;\n\
         1 j: translation; I m = 2; MSe f = c(k.q, 1); C k(q) = 2 * q; f -> j -> m; j -> k;",
    ),
    ("BG0342", "every ▸1 ms { } 1 j: translation; I m = 2; Se f = 1; f -> j -> m;"),
    ("BG0343", "every 1 ms { sample a: 1 = 2; } 1 j: translation; I m = 2; MSe f = ▸a.last; f -> j -> m;"),
    ("BG0344", "every 1 ms { sample ▸a: 1 = a + 1; } 1 j: translation; I m = 2; MSe f = a; f -> j -> m;"),
    ("BG0345", "1 j: translation; I m = 2 start ▸delay(1, 2 ms); j -> m;"),
    ("BG0332", "Se f = 1; 1 j: translation; I m = 2; C ▸s(effort e) = e; f -> j -> m; j -> s;"),
    ("BG0333", "graph ▸G { param a: 1 = 2; }"),
];

const CAUSALITY: [(&str, &str); 4] = [
    ("BG0401", "Se a = 1; 0 j: translation; TF g = 1; TF h = 2; 0 ▸k: translation; a -> j -> g -> k; j -> h -> k;"),
    ("BG0402", "Se a = 1; 0 j: translation; GY g = 1; GY h = 2; 0 ▸k: translation; a -> j -> g -> k; j -> h -> k;"),
    ("BG0403", "Se f = 1; 1 j: translation; I a = 2; I ▸b = 3; f -> j -> a; j -> b; expect integral causality;"),
    ("BG0404", "Sf a = 1; 1 j: translation; R ▸r(effort e) = 2 * e; a -> j -> r;"),
];

const EQUATIONS: [(&str, &str); 16] = [
    (
        "BG0501",
        "Se e = 1; 1 j: translation; param g: m/N^3/s = 1; R a = 1; 0 k; R b(effort e) = g * hold.effort * e * e; \
        e -> j -> a; j -> ▸k -> b;
         1 l: translation; I m = 2; rSe hold = 0; l -> m; l -> hold;",
    ),
    (
        "BG0502",
        "Se f = 1; 1 j: rotation; 1 k: translation; TF g(w) = 2 * w ▸* w; I m = 2; C c(x) = 2 * x; f -> j -> m; \
        j -> g -> k -> c;",
    ),
    ("BG0503", "Se f = 1; 1 j: translation; I m = 2; C s(q) = 3 ▸* exp(sin(q / 1)); f -> j -> m; j -> s;"),
    ("BG0504", "Se f = 1; 1 j: translation; I m = 2; C s(q) = 3 * q energy 3 * q ▸* q; f -> j -> m; j -> s;"),
    (
        "BG0505",
        "param k: N/m = 1;\n\
         1 j[3]: translation; position x of j; I m = 2; 1 s: translation; MTF d(v) = v.x;\n\
         C c = k at ▸x.y; j -> m; j -> d -> s -> c;",
    ),
    (
        "BG0506",
        "param k: N/m = 50;\n\
         1 j: translation; I m = 2;\n\
         C s(q) = if q < 1 { 0 } else { k * q } energy ▸if q < 1 { 0 } else { k * q * q / 2 };\n\
         j -> m; j -> s;",
    ),
    (
        "BG0507",
        "param k: N/m = 50;\n\
         1 j: translation; I m = 2; C s(q) = k * q * sqrt(-1) energy k * q ▸* q; j -> m; j -> s;",
    ),
    ("BG0508", "0 a: translation; 1 b: translation; 0 c: translation; 1 d; a -> ▸b -> c -> d -> a;"),
    ("BG0509", "1 a: rotation; I J = 2 start 1; I wheel = 3 start ▸4; a -> J; a -> wheel;"),
    ("BG0510", "input v: m/s; 1 a: translation; I ▸m = 2; Sf s = v; s -> a -> m;"),
    ("BG0511", "1 a: translation; I ▸m = 2; MSf s = if t < 1 { 0 } else { 1 }; s -> a -> m;"),
    (
        "BG0512",
        "param g: m/N^2/s = 1; 1 a: translation; I ▸m = 2; R r(effort e) = g * e * e; Se s = 10; s -> a -> m; a -> r;",
    ),
    (
        "BG0515",
        "body b { mass 1; inertia [1, 1, 1]; }\njoint guide: prismatic x (ground -> b) { rigid; }\n\
         friction ▸rub on guide { coulomb 0.3; normal guide.force.y; }",
    ),
    ("BG0516", "Sf drum = 1; 1 j: translation; R ▸rub(v) = 2 holds 3; drum -> j -> rub;"),
    (
        "BG0518",
        "param T: s = 1; param F: N = 1; let a: rad = ▸unwrapped(t, T, 1 / T); MSe f = a * F; 1 j: translation; \
        I m = 2; f -> j -> m;",
    ),
    ("BG0517", "Sf drum = 1; 1 j: translation; drum -> j; stop ▸end on j { at most 2; restitution 0.5; }"),
];

/// Values that no physics allows.
const VALUES: [(&str, &str); 4] = [
    ("BG0701", "Se f = 1; 1 j: translation; I m = 2; R r = -▸3; f -> j -> m; j -> r;"),
    ("BG0702", "body rod { mass 1; inertia ▸[[1, 2, 0], [0, 2, 0], [0, 0, 3]]; }"),
    ("BG0703", "body rod { sphere radius 1; density 1; start turned ▸[[1, 0.2, 0], [0, 1, 0], [0, 0, 1]]; }"),
    ("BG0704", "1 j: translation; I m = 2; j -> m; stop end on j { at most 2; restitution ▸1.2; }"),
];

/// More of what has a code: other words of it, and where they stand.
const MORE: [(&str, &str); 73] = [
    (
        "BG0209",
        "body rod { sphere radius 1; density 1; }\n\
         joint hook: universal x y (ground -> rod) { rigid; } drive push on ▸hook torque = 1;",
    ),
    (
        "BG0505",
        "body rod { sphere radius 1; density 1; }\n\
         1 up: translation; TF z(v) = dot([0, 0, 1], v); rod.translation -> z -> up -> floor;\n\
         rSe floor = 0 at ▸rod.position.x;",
    ),
    ("BG0102", "every ▸{ sample a: 1 = 2; }"),
    ("BG0101", "every 1 ms { ▸let a = 2; }"),
    ("BG0113", "every 1 ms { sample ▸a = 2; }"),
    (
        "BG0345",
        "every 2 ms { sample a: m/s = delay(j.flow, ▸5 ms); } 1 j: translation; I m = 2; MSe f = 1 N*s/m * a; \
        f -> j -> m;",
    ),
    ("BG0316", "every ▸1 m { sample a: 1 = 2; } 1 j: translation; I m = 2; MSe f = 1 N * a; f -> j -> m;"),
    (
        "BG0323",
        "every 1 s * ▸j.flow / (1 m/s) { sample a: 1 = 2; } 1 j: translation; I m = 2; MSe f = 1 N * a; f -> j -> m;",
    ),
    ("BG0339", "table ▸c: m -> N = [[0, 1]]; 1 j: translation; I m = 2; C k(q) = c(q); j -> m; j -> k;"),
    (
        "BG0339",
        "table c: m -> N = [[0, 1], ▸[1, 2, 3], [2, 3]]; 1 j: translation; I m = 2; C k(q) = c(q); j -> m; j -> k;",
    ),
    (
        "BG0339",
        "table ▸c: rad -> N*m = [[0, 1], [1, 2], [2, 3]], periodic; 1 j: rotation; I m = 2; C k(q) = c(q); j -> m; \
        j -> k;",
    ),
    (
        "BG0234",
        "table lift: rad -> m = [[0, 1], [3, 2], [6, 1]], spline;\nbody ball { sphere radius 0.1; density 1; }\n\
         contact c (ground profile ▸lift -> ball circle 0.1) { stiffness 1e5; }",
    ),
    (
        "BG0111",
        "body ball { sphere radius 0.1; density 1; }\ncontact c (ground ▸wall x -> ball circle 0.1) { stiffness 1e5; }",
    ),
    ("BG0102", "body ball { sphere radius 0.1; density 1; }\ncontact c (ground -> ball▸) { stiffness 1e5; }"),
    (
        "BG0203",
        "body ball { sphere radius 0.1; density 1; }\ncontact ▸c (ground line x -> ball circle 0.1) { damping 3; }",
    ),
    (
        "BG0204",
        "body ball { sphere radius 0.1; density 1; }\n\
         contact c (ground line x -> ball circle 0.1) { stiffness 1e5; damping 3; restitution ▸0.5; }",
    ),
    (
        "BG0704",
        "body ball { sphere radius 0.1; density 1; }\ncontact c (ground line x -> ball circle 0.1) { stiffness 1e5; \
        restitution ▸1; }",
    ),
    (
        "BG0203",
        "body ball { sphere radius 0.1; density 1; }\ncontact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; \
        }\n\
         friction ▸rub on c { coulomb 0.2; }",
    ),
    (
        "BG0204",
        "body rod { sphere radius 1; density 1; }\n\
         joint pin: spherical (ground -> rod) { stiffness 1; clearance ▸1e-4; }",
    ),
    (
        "BG0204",
        "body rod { sphere radius 1; density 1; }\njoint pin: revolute z (ground -> rod) { rigid; clearance ▸1e-4; }",
    ),
    (
        "BG0204",
        "body rod { sphere radius 1; density 1; }\n\
         joint pin: revolute z (ground -> rod) { stiffness 1; tilt stiffness 1; clearance 1e-4; length ▸0.1; }",
    ),
    (
        "BG0204",
        "body rod { sphere radius 1; density 1; }\n\
         joint gib: prismatic x (ground -> rod) { stiffness 1; tilt stiffness 1; exponent ▸1.5; }",
    ),
    (
        "BG0231",
        "body ball { sphere radius 0.1; density 1; }\ncontact ▸c (ground arc 0.3 from 0 to 1 -> ball) { stiffness 1e5; \
        }",
    ),
    (
        "BG0701",
        "body ball { sphere radius 0.1; density 1; }\n\
         contact c (ground arc 0.3 from 1 to ▸0.5 -> ball circle 0.1) { stiffness 1e5; }",
    ),
    (
        "BG0213",
        "body ball { sphere radius 0.1; density 1; }\ncontact c (ground plane y -> ball sphere 0.1) { stiffness 1e5; \
        }\n\
         stop end on ▸c { at most 1; stiffness 1e4; }",
    ),
    ("BG0102", "1 j: translation; I m = 2; j -> m; memory last: m/s = j.flow▸;"),
    ("BG0304", "table c: m -> N = [[0, 1], [1, 2]]; 1 j: translation; I m = 2; C k(q) = ▸c.slope(q); j -> m; j -> k;"),
    (
        "BG0339",
        "table c: m, V -> N = [[0, 1], [0, 1, 2], ▸[1, 2]];\n\
         1 j: translation; I m = 2; MSe f = c(k.q, 1); C k(q) = 2 * q; f -> j -> m; j -> k;",
    ),
    (
        "BG0306",
        "table c: m, V -> N = [[0, 1], [0, 1, 2], [1, 2, 3]];\n1 j: translation; I m = 2; MSe f = ▸c(k.q); \
        C k(q) = 2 * q; f -> j -> m; j -> k;",
    ),
    ("BG0102", "1 slide ▸translation; I m = 2; slide -> m;"),
    ("BG0102", "let stiffness ▸N = 2;\n1 slide: translation; I m = 2; slide -> m;"),
    ("BG0102", "body rod { mass 1; inertia [1, 1, 1]; point end = [0, 1, 0]; start end at 0▸, 1, 0; }"),
    ("BG0102", "body rod { mass 1; inertia [1, 1, 1]; start at (0▸, 1, 0); }"),
    ("BG0102", "1 j: translation; I m = 2; R r = 3 ▸seconds; j -> m; j -> r;"),
    (
        "BG0207",
        "ground { point O = [0, 0, 0]; } ▸ground { point P = [1, 0, 0]; }\n\
         body rod { mass 1; inertia [1, 1, 1]; } joint a: spherical (ground.O -> rod) { rigid; }\n\
         joint b: spherical (ground.P -> rod) { rigid; }",
    ),
    ("BG0301", "param a: ▸furlong = 90; Se f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0303", "body rod { mass 1; inertia [1, 1, 1]; start turned rotation_z(▸pi / 2); }"),
    (
        "BG0316",
        "1 coil: electrical; I L = 1e-3; body rod { mass 1; inertia [1, 1, 1]; }\n\
         joint ▸pin: revolute z (ground -> rod) { rigid; } coil -> L; coil -> pin.spin;",
    ),
    ("BG0316", "1 coil: electrical; I L = 1e-3; 1 ▸shaft: rotation; I J = 1; coil -> L; coil -> shaft -> J;"),
    ("BG0701", "body ▸rod { sphere radius 1; density 1e-320; }"),
    ("BG0202", "body rod { sphere radius 1; density 1; }\njoint pin: spherical (ground -> ▸rod.end) { stiffness 1; }"),
    ("BG0202", "body rod { sphere radius 1; density 1; point end = [1, 0, 0]; start ▸top at [0, 0, 0]; }"),
    ("BG0203", "1 j: translation; I m = 2; j -> m; friction ▸rub on j { viscous 2; }"),
    ("BG0203", "1 j: translation; I m = 2; j -> m; stop ▸end on j { at most 2; }"),
    ("BG0203", "1 j: translation; I m = 2; j -> m; stop ▸end on j { restitution 0.5; }"),
    ("BG0204", "1 j: translation; I m = 2; j -> m; stop end on j { at most 2; stiffness 1; rest below ▸1; }"),
    ("BG0316", "param e: m = 1; 1 j: translation; I m = 2; j -> m; stop end on j { at most 2; restitution ▸e; }"),
    (
        "BG0323",
        "param T: s = 1; 1 j: translation; I m = 2; j -> m; stop end on j { at most 2; restitution 0.1 * ▸t / T; }",
    ),
    ("BG0326", "Se f = 1; 1 j: translation; I m = 2; R ▸r = 2 restitution 0.5; f -> j -> m; j -> r;"),
    ("BG0704", "1 j: translation; I m = 2; j -> m; stop ▸end on j { at most 2; start 3; restitution 0.5; }"),
    ("BG0203", "Se p = 1; 1 j: hydraulic; p -> j; orifice ▸o on j { area 1; coefficient 1; density 1; }"),
    ("BG0204", "1 j: translation; I m = 2; j -> m; friction rub on j { coulomb 2; stribeck ▸3; }"),
    ("BG0303", "1 j: translation; I m = 2; j -> m; friction rub on ▸jj { coulomb 2; }"),
    ("BG0320", "param f: m = 2; 1 j: translation; I m = 2; j -> m; friction ▸rub on j { coulomb 2; static f; }"),
    ("BG0320", "1 j: translation; I m = 2; param f: m = 2; R r(v) = 3 holds ▸f; j -> m; j -> r;"),
    ("BG0326", "1 j[3]: translation; I m = 2; R ▸r(v) = 2 * v holds 2; j -> m; j -> r;"),
    ("BG0515", "1 j: translation; I m = 2; j -> m; R rub(v) = 0.1 ▸* rub.effort holds 2; j -> rub;"),
    (
        "BG0516",
        "input speed: m/s; Sf drum = speed; 0 b: translation; 1 j, s: translation; I m = 2; R ▸rub(v) = 2 holds 3;\n\
         drum -> b -> j -> m; b -> s -> rub;",
    ),
    ("BG0314", "gravity -▸9.81;\nbody rod { sphere radius 1; density 1; }"),
    ("BG0314", "Se f = 1; 1 j: translation; I m = 2; R r = norm(▸[0, 1]); f -> j -> m; j -> r;"),
    ("BG0314", "body rod { sphere radius 1; density 1; point end = ▸[0, 1]; }"),
    ("BG0314", "body rod { mass 1; inertia ▸2; }"),
    ("BG0314", "let v: m/s = [1, 2, 3]; body rod { sphere radius 1; density 1; start velocity guess(▸v); }"),
    ("BG0318", "param a: m = 1;\nlet c = ▸root(sqrt(a), sqrt(a));\nSe f = 1; 1 j: translation; I m = 2; f -> j -> m;"),
    ("BG0323", "let v: m/s = 1; body rod { sphere radius 1; density 1; point end = [v * ▸t, 0, 0]; }"),
    (
        "BG0323",
        "param T: s = 1; input f: N; let k: N/m = f / 1; body rod { sphere radius 1; density 1; }\n\
                joint pin: spherical (ground -> rod) { stiffness ▸k; damping 1; }",
    ),
    (
        "BG0323",
        "param T: s = 1; body rod { sphere radius 1; density 1; }\n\
                joint pin: spherical (ground -> rod) { stiffness 1; damping 2 * ▸t / T; }",
    ),
    ("BG0330", "body rod { mass ▸guess(2); inertia [1, 1, 1]; }"),
    ("BG0701", "body rod { cuboid ▸[1, 1, -1]; density 1; }"),
    ("BG0701", "let heavy: kg = 2; body rod { mass 1 ▸- heavy / 2; inertia [1, 1, 1]; }"),
    ("BG0701", "Se f = 1; 0 j: hydraulic; R r(effort p) = 1e-8 * root(p, ▸0); f -> j -> r;"),
    ("BG0702", "body rod { mass 1; inertia ▸[1, 1, 100]; }"),
    ("BG0703", "body rod { sphere radius 1; cuboid [1, 2, 3] turned ▸diagonal([1, 1, -1]); density 1; }"),
];

/// A mass on a spring, with a place for scenes.
const SCENES: [(&str, &str); 12] = [
    (
        "BG0601",
        "Se f = 1; 1 j: translation; I m = 2; f -> j -> m; scene A { observe { m.p } } scene ▸A { observe { j.flow } }",
    ),
    ("BG0602", "Se f = 1; 1 j: translation; I m = 2; f -> j -> m; scene A { without { ▸g } }"),
    ("BG0603", "param a: N = 1; Se f = a; 1 j: translation; I m = 2; f -> j -> m; scene A { tune { ▸b } }"),
    (
        "BG0604",
        "body rod { sphere radius 1; density 1; start spin [1, 1, 0]; }\n\
         scene A { observe { rod.orientation } expect ▸planar; }",
    ),
    ("BG0605", "Se f = 1; 1 j: translation; I m = 2; f -> j -> m; scene A { observe { m.p } expect states = ▸2; }"),
    (
        "BG0606",
        "body rod { sphere radius 1; density 1; }\njoint pin: spherical (ground -> rod) { stiffness 1; }\n\
         scene A { rigid { ▸pon } }",
    ),
    ("BG0608", "Se f = 1; 1 j: translation; I m = 2; f -> j -> m; start ▸impulse;"),
    ("BG0609", "Se f = 1; 1 j: translation; I m = 2; f -> j -> m; ▸scenes only;"),
    (
        "BG0610",
        "param a: N = 1; Se f = a; 1 j: translation; I m = 2; f -> j -> m; scenes only; \
        scene A { tune {} } scene ▸B {}",
    ),
    (
        "BG0611",
        "gravity [1, 0, 0]; ground { point O = [0, 0, 0]; } body rod { sphere radius 1; density 1; start at [0, 1, 0]; \
        point low = [0, -1, 0]; }\n\
         joint pin: revolute z (ground.O -> rod.low) { rigid; }\n\
         scene A { all reactions; expect ▸independent speeds; }",
    ),
    ("BG0612", "body rod { sphere radius 1; density 1; }\nscene A { dependent ▸rood; }"),
    (
        "BG0613",
        "gravity [0, 1, 0]; ground { point O = [0, 0, 0]; } body rod { sphere radius 1; density 1; start at [1, 0, 0]; \
        point low = [-1, 0, 0]; }\n\
         joint pin: revolute z (ground.O -> rod.low) { rigid; }\n\
         scene A { dependent ▸rod; }",
    ),
];

/// Parts and graphs that use them.
const PARTS: [(&str, &str); 16] = [
    ("BG0801", "graph G { part a: ▸Lag; }\npart Leg { let a = 1; }"),
    ("BG0802", "graph G { part a: Leg { ▸k = 1; } }\npart Leg { param j: 1 = 2; let a = j; }"),
    ("BG0803", "graph G { part a: Leg; }\npart Leg { part b: ▸Leg; }"),
    ("BG0804", "graph G { part ▸a: Leg; }\npart Leg { port hub: translation; I m = 2; hub -> m; }"),
    ("BG0805", "graph G { part a[2]: Leg; let b = ▸a[2].a; }\npart Leg { let a = 1; }"),
    ("BG0806", "graph G { part a: Leg; let b = ▸a[0].a; }\npart Leg { let a = 1; }"),
    ("BG0807", "graph G { part a[2]: Leg; let b = ▸a[i].a; }\npart Leg { let a = 1; }"),
    ("BG0808", "graph G { for i in 3..▸1 { let b[i] = 1; } }"),
    (
        "BG0809",
        "graph G { param a_b: N = 1; part a: Leg; Se f = a_b; 1 j: translation; I m = 2; f -> j -> m; }\n\
         part Leg { param ▸b: 1 = 2; let a = b; }",
    ),
    ("BG0810", "graph G { part a: Leg { k = -▸2; } }\npart Leg { param k: 1 = 2, above 0; let a = k; }"),
    ("BG0811", "part Leg { param ▸k: 1 = 2; }"),
    ("BG0812", "graph G { start ▸rod at [0, 0, 0]; }"),
    ("BG0813", "graph G { body rod { sphere radius 1; density 1; } start rod at [0, 0, 0]; start ▸rod at [0, 0, 1]; }"),
    ("BG0814", "graph G { observe { all of ▸a } }"),
    (
        "BG0815",
        "graph ▸G { for i in 0..9000 { for j in 0..9000 { let a[i][j] = 1; } } part b: Leg { c = 1; \
        } }\npart Leg { let a = 1; }",
    ),
    ("BG0816", "graph G { part a: Leg; let b = ▸a.length; }\npart Leg { let lenght = 1; }"),
];

/// More of parts.
const MORE_OF_PARTS: [(&str, &str); 11] = [
    ("BG0816", "graph G { part a: Leg; let b = ▸a; }\npart Leg { let c = 1; observe { way = c } }"),
    (
        "BG0802",
        "graph G { part a: Leg { ▸foot.j = 1; } }\npart Leg { part foot: Foot { j = 1; } }\n\
         part Foot { param j: 1 = 2; let a = j; }",
    ),
    ("BG0804", "graph G { part ▸a: Leg; }\npart Leg { port hub: translation; port foot: translation; hub -> foot; }"),
    (
        "BG0811",
        "graph G { param ▸k: N = 1; Se f = 2; 1 j: translation; I m = 2; f -> j -> m; observe { j.flow }\n\
         scene S { tune { k } } }",
    ),
    ("BG0806", "graph G { part a[2]: Leg; let b = ▸a.a; }\npart Leg { let a = 1; }"),
    ("BG0807", "graph G { for i in 0..2 { for ▸i in 0..2 { let b[i] = 1; } } }"),
    ("BG0808", "graph G { part a[▸100000]: Leg; }\npart Leg { let a = 1; }"),
    ("BG0814", "graph G { part a: Leg; observe { all of ▸a } }\npart Leg { let a = 1; }"),
    (
        "BG0320",
        "graph G { part a[9]: Leg; Se f = 1; 1 j: translation; f -> j; for i in 0..9 { j -> a[i].hub; \
        } }\npart Leg { param k: N = 1; port hub: translation; I m = ▸k; hub -> m; }",
    ),
    (
        "BG0316",
        "graph G { param k: kg = 1; part a: Leg { l = ▸k; } Se f = 1; 1 j: translation; I m = 2; f -> j -> m; \
        }\npart Leg { param l: m = 1; let a = l; }",
    ),
    ("BG0303", "part Leg { port hub: translation; I m = ▸mass; hub -> m; }"),
];

/// Texts that use files.
const FILES: [(&str, &str); 8] = [
    ("BG0901", "use ▸\"shift.bond\"; graph G {}"),
    ("BG0902", "use \"circle.bond\"; graph G {}"),
    ("BG0903", "use \"0\"; graph G {}"),
    ("BG0904", "use \"shaft.bond\"; use \"needs.bond\"; graph G {}"),
    ("BG0905", "use ▸\"graph.bond\"; graph G {}"),
    ("BG0906", "graph G ▸("),
    ("BG0907", "graph G { table curve: rpm -> N*m = ▸\"curve.csv\"; }"),
    ("BG0908", "use ▸gear; graph G {}"),
];

/// The files that they use; one that is called as a number uses the next one.
fn marked(path: &Path) -> Result<String, String> {
    let name = path.to_str().unwrap_or_default();
    let text = match name {
        "circle.bond" => "use ▸\"circle.bond\";",
        "curve.csv" => "speed [rpm],torque [N*m]\n0,12\n100,twelve\n",
        "shaft.bond" => "part Shaft { let a = 1; }",
        "needs.bond" => "\n part Both { part one: ▸Shaft; }",
        "graph.bond" => "graph G {}",
        _ => "",
    };
    match name.parse::<u32>() {
        Ok(number) => Ok(format!("use ▸\"{}\";", number + 1)),
        Err(_) if text.is_empty() => Err(format!("cannot read `{name}`")),
        Err(_) => Ok(text.to_owned()),
    }
}

/// A text with the files that it uses.
fn gathered(text: &str) -> Gathered {
    let opened = |path: &Path, text: &str| Opened { file: path.to_owned(), text: text.replace(MARK, "") };
    let open = |path: &Path| marked(path).map(|text| opened(path, &text));
    files::gather(FIRST.as_ref(), opened(FIRST.as_ref(), text), &open)
}

/// The path of a text that uses files.
const FIRST: &str = "first.bond";

/// All stages that have faults.
fn compiled(text: &str) -> Staged<()> {
    let source = syntax::parse(text.parse().unwrap_or_else(|error| panic!("{error}\n{text}")))?;
    pipeline::models(&source).map(drop)
}

/// The source with its mark removed and the mark's line and column, counted from 1.
fn unmarked(text: &str) -> (String, (usize, usize)) {
    let Some(at) = text.find(MARK) else { return (text.to_owned(), (1, 1)) };
    let before = &text[..at];
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
    (text.replace(MARK, ""), (line, column))
}

fn place(fault: &Fault) -> (usize, usize) {
    (fault.span.start().line, fault.span.start().column + 1)
}

fn source(statements: &str) -> String {
    match statements {
        "" => MARK.to_string(),
        _ if ["graph", "part", "▸use"].iter().any(|word| statements.starts_with(word)) => statements.to_owned(),
        DEEP => format!("graph G {{\nlet a = {}{MARK}(1){};\n}}", "(".repeat(100), ")".repeat(100)),
        _ => format!("graph G {{\n{statements}\n}}"),
    }
}

fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    of_one_text().chain(FILES)
}

fn of_one_text() -> impl Iterator<Item = (&'static str, &'static str)> {
    SYNTAX
        .into_iter()
        .chain(MECHANISM)
        .chain(GRAPH)
        .chain(CAUSALITY)
        .chain(EQUATIONS)
        .chain(VALUES)
        .chain(SCENES)
        .chain(PARTS)
}

#[test]
fn each_fault_has_its_code_and_its_place() {
    let mut wrong = String::new();
    for (code, statements) in of_one_text().chain(MORE).chain(MORE_OF_PARTS) {
        let (text, expected) = unmarked(&source(statements));
        let faults = compiled(&text).err().unwrap_or_default();
        let found: Vec<_> = faults.iter().map(|fault| (fault.code, place(fault))).collect();
        if found != [(code, expected)] {
            let _ = writeln!(wrong, "{code} at {expected:?}: {found:?}\n{text}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn each_fault_of_files_has_its_code_and_its_place_in_its_file() {
    for (code, text) in FILES {
        let gathered = gathered(text);
        let [fault] = gathered.faults.as_slice() else { panic!("{text}: {:?}", gathered.faults) };
        let file = &gathered.files[gathered.place(fault.span)].path;
        let marked = if file == Path::new(FIRST) { text.to_owned() } else { marked(file).expect("it was there") };
        assert_eq!((fault.code, place(fault)), (code, unmarked(&marked).1), "{text}");
    }
}

#[test]
fn the_catalogue_of_faults() {
    let mut catalogue = String::new();
    for (code, statements) in of_one_text().chain(MORE).chain(MORE_OF_PARTS) {
        let (text, _) = unmarked(&source(statements));
        for fault in compiled(&text).err().unwrap_or_default() {
            let statements = if statements == DEEP { "let a = ((...((1))...));" } else { statements };
            let _ = writeln!(catalogue, "{statements}\n{fault}\n");
            assert_eq!(fault.code, code);
            assert!(!fault.message.is_empty() && !fault.help.is_empty(), "{fault}");
        }
    }
    for (_, text) in FILES {
        gathered(text).faults.iter().for_each(|fault| _ = writeln!(catalogue, "{text}\n{fault}\n"));
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(".");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("catalogue", catalogue));
}

/// All codes in the compiler's source.
fn codes(folder: &Path, found: &mut BTreeSet<String>) {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for path in entries.map(|entry| entry.expect("a readable folder").path()) {
        if path.is_dir() {
            codes(&path, found);
        } else {
            let text = std::fs::read_to_string(&path).expect("a source file is text");
            let quoted = text.split('"').filter(|part| part.len() == 6 && part.starts_with("BG"));
            found.extend(quoted.map(str::to_owned));
        }
    }
}

#[test]
fn no_code_of_the_compiler_is_without_a_case() {
    let mut known = BTreeSet::new();
    codes(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../bg-macros/compiler/src"), &mut known);
    let shown: BTreeSet<String> = all().map(|(code, _)| code.to_owned()).collect();
    assert_eq!(all().count(), shown.len(), "each fault once");
    assert_eq!(shown, known);
}

/// The faults of a source in which every mark is the place of one, in their order.
fn check_all(text: &str, codes: &[&str]) {
    let mut rest = text.to_owned();
    let mut places = Vec::new();
    while rest.contains(MARK) {
        let at = rest.find(MARK).expect("there is a mark");
        let (_, place) = unmarked(&rest[..at + MARK.len_utf8()]);
        places.push(place);
        rest.replace_range(at..at + MARK.len_utf8(), "");
    }
    let mut faults = compiled(&rest).expect_err("the source has faults");
    faults.sort_by_key(place);
    let found: Vec<_> = faults.iter().map(|fault| (fault.code, place(fault))).collect();
    let expected: Vec<_> = codes.iter().copied().zip(places).collect();
    assert_eq!(found, expected, "{rest}");
}

#[test]
fn all_faults_of_a_stage_come_at_once() {
    check_all(
        "graph G {\nparam ▸a = 1;\nI m = 2 ▸^ 3;\n▸wheel w;\n1 ▸= j;\n}",
        &["BG0113", "BG0104", "BG0101", "BG0102"],
    );
    check_all(
        "graph G {\nbody ▸rod { density 1; }\njoint ▸pin: spherical (ground -> rod);\n\
         drive push on ▸rot torque = 1;\nspring s (ground -> ▸road) { stiffness 1; }\n}",
        &["BG0205", "BG0203", "BG0208", "BG0201"],
    );
    // Names and ports.
    check_all(
        "graph G {\nparam m: ▸kgs = 1;\nSe f = ▸force; 1 j: ▸linear; I ▸m = 1;\nf -> j -> ▸mass;\n}",
        &["BG0301", "BG0303", "BG0305", "BG0302", "BG0303"],
    );
    // What uses a name that is declared twice is no fault of its own.
    check_all(
        "graph G {\nparam push: N = 1;\nSe ▸push = 2; 1 j: translation; I m = 1; R r = push.flow;\n\
         push -> j -> m; j -> r;\nobserve { push: N = push }\n}",
        &["BG0302"],
    );
    // Shapes and units.
    check_all(
        "graph G {\nparam k: N = 1; param f: m/s = 1;\nSe push = ▸f; 1 j: translation; I m = ▸k; C s = ▸1;\n\
         R r = ▸[1, 2, 3];\npush -> j -> m; j -> s; j -> r;\nobserve { v: m = ▸j.flow }\n}",
        &["BG0320", "BG0320", "BG0321", "BG0314", "BG0316"],
    );
    check_all(
        "graph G {\nSe f = 1; 1 j: translation; I m = 2;\nC a(q) = 3 ▸* exp(sin(q / 1)); \
        C b(q) = 2 * q energy 2 ▸* q;\n\
         f -> j -> m; j -> a; j -> b;\n}",
        &["BG0503", "BG0504"],
    );
}

#[test]
fn all_faults_of_causality_come_at_once() {
    // A derivative storage, a junction that two sources determine, a law the wrong way round, a junction without a
    // cause.
    check_all(
        "graph G {\n1 a: translation; I i = 1; I ▸k = 2; a -> i; a -> k;\n0 b: translation; Se s = 1; Se ▸u = 2; \
        s -> b; u -> b;\n\
         1 c: translation; Sf f = 1; R ▸r(effort e) = e / 2; f -> c -> r;\n1 ▸d: translation; Se e = 1; e -> d;\n\
         expect integral causality;\n}",
        &["BG0403", "BG0401", "BG0404", "BG0402"],
    );
}

#[test]
fn all_algebraic_loops_come_at_once() {
    // Two loops, one with several circles in it, which is one fault all the same; and an energy that is not known.
    let text = "graph G {\nparam g: m/N^3/s = 1; Se e = 1; 1 j: translation; R a = 1; 0 k; \
        R b(effort e) = g * hold.effort * e * e; e -> j -> a; j -> ▸k -> b;\n\
         Se f = 1; 1 l: translation; R c = 1; 0 m; R d(effort e) = g * hold.effort * e * e; 1 n; R g1 = 3; 0 o; \
         R h = 4; f -> l -> c; l -> ▸m -> d;\n\
         m -> n -> g1; n -> o -> h;\n1 p: translation; I i = 1; C s(q) = 3 ▸* exp(sin(q / 1)); p -> i; p -> s;\n\
         1 q: translation; I u = 2; rSe hold = 0; q -> u; q -> hold;\n}";
    check_all(text, &["BG0501", "BG0501", "BG0503"]);
    // A loop of junctions names these.
    let faults =
        compiled("graph G { 0 a: translation; 1 b: translation; 0 c: translation; 1 d; a -> b -> c -> d -> a; }");
    let message = &faults.expect_err("a loop")[0].message;
    assert!(message.starts_with("algebraic loop: `a`, `b`, `c`, `d` need each other"), "{message}");
}

#[test]
fn all_domains_that_are_missing_come_at_once() {
    // Three parts without units; in the third the transformer's parameter takes those of one side to the other. A
    // fourth part has two domains, a fifth a law that fits none.
    let text = "graph G {\nparam ratio: m/rad = 2; param k: N/m = 3;\n\
         Se a = 1; 1 j; I b = 2; a -> ▸j -> b;\nSe c = 1; 0 l; R d = 2; c -> ▸l -> d;\n\
         Se e = 1; 1 m; TF g = ratio; 1 n; I h = 2; R q = 3; e -> ▸m -> g -> n -> h; m -> q;\n\
         1 o: translation; 1 ▸p: rotation; Se r = 1; I s = 2; r -> o -> p -> s;\n\
         1 u: translation; Se v = ▸k; I w = 2; v -> u -> w;\n}";
    check_all(text, &["BG0319", "BG0319", "BG0319", "BG0316", "BG0320"]);
}

/// What stands in backticks last in the help of the only fault.
fn advice(text: &str, code: &str) -> String {
    let faults = compiled(text).expect_err(text);
    assert_eq!(faults.iter().map(|fault| fault.code).collect::<Vec<_>>(), [code], "{text}");
    let mut parts = faults[0].help.rsplit('`');
    parts.nth(1).unwrap_or_else(|| panic!("{}", faults[0])).to_owned()
}

#[test]
fn the_advice_on_missing_domains_leads_to_a_graph_that_compiles() {
    for (declaration, rest) in [
        ("1 j", "Se f = 1; I m = 2; f -> j -> m;"),
        ("0 k", "R r = 1; I m = 2; k -> r; k -> m;"),
        ("1 w[3]", "I m = 2; R r = 1; w -> m; w -> r;"),
    ] {
        let graph = |declaration: &str| format!("graph G {{ {declaration}; {rest} }}");
        let advised = advice(&graph(declaration), "BG0319");
        assert_eq!(advised, format!("{declaration}: rotation"));
        assert!(compiled(&graph(&advised)).is_ok(), "{advised}");
    }
    // Without a junction there is none to name it at.
    let graph = |chain: &str| format!("graph G {{ Se e = 1; R r = 2; {chain} }}");
    assert!(compiled(&graph(&advice(&graph("e -> r;"), "BG0319"))).is_ok());
}

#[test]
fn the_advice_on_derivative_causality_leads_to_a_graph_that_compiles() {
    let graph = |declared: &str, chain: &str| {
        format!(
            "graph G {{ Se e = 1; 1 shaft: rotation; I rotor = 2; I wheel = 3; e -> shaft -> rotor; \
            {declared} {chain} }}"
        )
    };
    let faults = compiled(&graph("expect integral causality;", "shaft -> wheel;")).expect_err("two I on one junction");
    let help = &faults[0].help;
    assert!(
        help.contains("C and an R") && help.contains("`rSe rigid = 0` at the 0-junction of `.. -> 0 -> 1 -> wheel`"),
        "{help}"
    );
    for declared in [
        "0 tie; 1 hub; rSe rigid = 0; rigid -> tie;",
        "0 tie; 1 hub; 1 k; C c(q) = 4 * q; R r = 1; tie -> k -> c; k -> r;",
    ] {
        let fixed = compiled(&graph(declared, "shaft -> tie -> hub -> wheel;"));
        assert!(fixed.is_ok(), "{declared}: {}", fixed.expect_err("faults")[0]);
    }
    // The exact rigid gear.
    let gear = graph(
        "TF gear = 3; 0 tie; 1 hub: rotation; rSe rigid = 0; rigid -> tie;",
        "shaft -> gear -> tie -> hub -> wheel;",
    );
    assert!(compiled(&gear).is_ok());
}

#[test]
fn the_faults_of_all_graphs_come_at_once() {
    let text = "graph A { Se a = 1; 1 j: translation; I m = mass; a -> j -> m; }\n\
                graph B { Se a = 1; Se b = 1; 0 j: translation; a -> j; b -> j; }\n\
                graph C { Se a = 1; 1 j: translation; I m = 1; a -> j -> m; scene D { observe { m.p } } }";
    let items = bg_compiler::compile(text.parse().expect("tokens")).to_string();
    assert!(items.contains("BG0303") && items.contains("BG0401"), "the faults of both graphs");
    assert_eq!(items.matches("compile_error").count(), 2);
    for name in ["A", "B", "C", "D"] {
        assert!(items.contains(&format!("pub struct {name} ")) || items.contains(&format!("struct {name} ")), "{name}");
    }
}

#[test]
fn a_circle_of_lets_is_a_fault() {
    let text = "graph G {\nlet ▸a = b; let ▸b = a;\nSe f = a; 1 j: translation; I m = 2; f -> j -> m;\n}";
    check_all(text, &["BG0324", "BG0324"]);
}
