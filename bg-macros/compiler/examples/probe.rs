//! x
use bg_compiler::*;
fn main() {
    let text = std::fs::read_to_string(std::env::args().nth(1).unwrap()).unwrap();
    let t0 = std::time::Instant::now();
    let source = match syntax::parse(text.parse().unwrap()) { Ok(s) => s, Err(f) => { for f in f { println!("{:?} {f}", f.span.start()); } return; } };
    println!("parse {:?}", t0.elapsed());
    for g in &source.graphs {
        let t0 = std::time::Instant::now();
        let e = match mechanism::expand(g) { Ok(s) => s, Err(f) => { for f in f { println!("{:?} {f}", f.span.start()); } return; } };
        println!("expand {:?}", t0.elapsed());
        if std::env::args().nth(2).is_some() { println!("{e}"); }
        let t0 = std::time::Instant::now();
        let r = match graph::resolve(&e) { Ok(s) => s, Err(f) => { for f in f { println!("{:?} {f}", f.span.start()); } return; } };
        println!("resolve {:?}", t0.elapsed());
        let t0 = std::time::Instant::now();
        let c = match causality::assign(r) { Ok(s) => s, Err(f) => { for f in f { println!("{:?} {f}", f.span.start()); } return; } };
        println!("causality {:?}", t0.elapsed());
        let t0 = std::time::Instant::now();
        let q = match equations::derive(&c) { Ok(s) => s, Err(f) => { for f in f { println!("{:?} {f}", f.span.start()); } return; } };
        println!("equations {:?} states {} nodes {}", t0.elapsed(), q.states.len(), q.pool.len()); let mut q = q; let t0 = std::time::Instant::now(); let tokens = emit::model(&c, &mut q); println!("emit {:?}", t0.elapsed()); let text = tokens.to_string(); println!("bytes {}", text.len()); std::fs::write("/tmp/hs/out.rs", text).unwrap();
    }
}
