//! x
use bg_model::input::Input;
use bg_model::integrator::*; use bg_model::simulation::*; use bg_model::system::*;
use bond_graph_tests::examples::hydraulic_cylinder::*;
#[test]
fn scratch() {
    let p = HydraulicCylinderParameters { load: 0.0, ..Default::default() };
    let pump_flow = Input::function(|t| 1e-4 * (10.0 * t).cos());
    let m = HydraulicCylinder::new(p, HydraulicCylinderInputs { pump_flow }).unwrap();
    let start = m.start().unwrap();
    struct O(Vec<(f64,f64,bool)>, Vec<f64>);
    impl Observer<4,1> for O { fn sample(&mut self,t:f64,x:&bg_model::nalgebra::SVector<f64,4>,n:&[bool;1]) { self.0.push((t,x[0]/3.5714285714e-13,n[0])); } fn event(&mut self,t:f64,x:&bg_model::nalgebra::SVector<f64,4>,_s:usize,_n:&[bool;1]) { self.1.push(t); println!("event {t:e} p {:e}", x[0]/3.5714285714e-13);} }
    for atol in [1e-13, 1e-18] {
    let mut o = O(vec![],vec![]);
    let s = Settings{tolerances: Tolerances::new(1e-10,atol), largest_step: 0.005, ..Settings::default()};
    let f = integrate(&m,&mut Dop853::new(),&start,Span{t0:0.0,t_end:1.0},&s,&mut o);
    match f { Ok(f) => println!("{}", f.statistics), Err(e) => println!("{e} {:?}", e.last) }
    for r in o.0.iter().rev().take(8) { println!("{r:?}"); }
    }
}
