use bg_model::system::Model;
use hacksaw::mechanism::*;
fn show<M: Model<f64,N,G,O>, const N:usize,const G:usize,const O:usize>(m:&M){
 let d=m.description();
 println!("== {} doc={:?} N={N} G={G} M={O} params={} el={} bonds={} eq={} ops={:?}",d.name,d.doc,d.parameters.len(),d.elements.len(),d.bonds.len(),d.equations.len(),d.operations);
 println!("RED:\n{}",d.reduction);
 println!("graph {} bytes, head:\n{}",d.graph.len(), d.graph.lines().take(12).collect::<Vec<_>>().join("\n"));
 println!("{:?}\n{:?}\n{:?}",&d.elements[..3],&d.bonds[..3],&d.states[..3]);
 for e in &d.equations[..5]{println!("{e}");}
 for e in &d.equations[d.equations.len()-3..]{println!("{e}");}
 for o in d.outputs{print!("{} ",o.name)} println!();
 println!("{:?}", d.switches);
}
fn main(){
 show(&Hacksaw::new(Default::default()).unwrap());
 show(&Paper::new(Default::default()).unwrap());
 show(&Full::new(Default::default()).unwrap());
 show(&Angles::new(Default::default()).unwrap());
 show(&FreeRun::new(Default::default()).unwrap());
}
