//! Names that generated code could take for its own: those of Rust, of the code's own items, of keywords in some
//! editions, and what the user has in scope. None is forbidden, and the models are right.
#![allow(dead_code, non_camel_case_types, non_snake_case, non_upper_case_globals)]

use bg_model::nalgebra::SVector;
use bg_model::system::Model as Runs;

/// A mass on a spring under each of these names. A parameter, a state and an output are called like something as well.
macro_rules! models {
    ($($module:ident $name:ident $parameters:ident $inputs:ident;)*) => {
        $(
            mod $module {
                ::bg_model::bond_graph! {
                    pub graph $name {
                        param gen: kg = 2, above 0;
                        param f64: N/m = 3, above 0;
                        input push: N;
                        1 slide: translation; Se force = push; I N = gen; C x = f64 start 0.5;
                        R v0(v) = if v < 0 { 4 * v } else { sqrt(v * v) * 5 };
                        force -> slide -> N; slide -> x; slide -> v0;
                        observe { v: m/s = slide.flow; M: J = integral(-force.power); None: m*s = integral(x.q) }
                    }
                }
                pub fn rates() -> ::std::string::String {
                    let parameters = $parameters { r#gen: 4.0, ..::std::default::Default::default() };
                    let model = $name::new(parameters.clone(), $inputs { push: 1.0.into() }).expect("in range");
                    ::std::assert_eq!(model.clone().parameters(), &parameters);
                    super::rates(&model)
                }
            }
        )*
        fn all() -> Vec<(&'static str, String)> {
            vec![$((stringify!($name), $module::rates())),*]
        }
    };
}

models! {
    n00 M MParameters MInputs;
    n01 N NParameters NInputs;
    n02 G GParameters GInputs;
    n03 S SParameters SInputs;
    n04 T TParameters TInputs;
    n05 F FParameters FInputs;
    n06 D DParameters DInputs;
    n07 Scalar ScalarParameters ScalarInputs;
    n08 SVector SVectorParameters SVectorInputs;
    n09 Option OptionParameters OptionInputs;
    n10 Result ResultParameters ResultInputs;
    n11 Some SomeParameters SomeInputs;
    n12 None NoneParameters NoneInputs;
    n13 Default DefaultParameters DefaultInputs;
    n14 Clone CloneParameters CloneInputs;
    n15 f64 f64Parameters f64Inputs;
    n16 u8 u8Parameters u8Inputs;
    n17 u16 u16Parameters u16Inputs;
    n18 u32 u32Parameters u32Inputs;
    n19 usize usizeParameters usizeInputs;
    n20 str strParameters strInputs;
    n21 bool boolParameters boolInputs;
    n22 bg_model bg_modelParameters bg_modelInputs;
    n23 core coreParameters coreInputs;
    n24 std stdParameters stdInputs;
    n25 Model ModelParameters ModelInputs;
    n26 Parameters ParametersParameters ParametersInputs;
    n27 Inputs InputsParameters InputsInputs;
    n28 DESCRIPTION DESCRIPTIONParameters DESCRIPTIONInputs;
    n29 derive deriveParameters deriveInputs;
    n30 Vec VecParameters VecInputs;
    n31 String StringParameters StringInputs;
    n32 Box BoxParameters BoxInputs;
}

/// What the user has in scope is not what the generated code means.
mod own {
    pub struct Option;
    pub struct Result;
    pub struct Vec;
    pub struct Scalar;
    pub struct SVector;
    pub struct v0;
    pub struct L_p;
    pub const c: u8 = 1;
    pub static x: u8 = 2;
    pub type f64 = u8;
    pub mod core {}
    pub mod std {}
    pub fn Some() {}
    pub trait Default {}
    pub trait Functions {
        fn tanh(&self) {}
        fn value(&self) {}
        fn try_into(&self) {}
    }
    impl<T> Functions for T {}

    ::bg_model::bond_graph! {
        pub graph Coil {
            input voltage: V;
            1 circuit: electrical; I L = 2 start 0.5; R r(f) = 1 * tanh(f / 1); Se e = voltage;
            e -> circuit -> L; circuit -> r;
        }
    }
}

/// Nothing is in scope but what a module brings in itself.
#[no_implicit_prelude]
mod bare {
    ::bg_model::bond_graph! {
        pub graph Tank {
            param throttle: Pa*s/m^3 = 2, above 0;
            param capacity: m^3/Pa = 0.25, above 0;
            input inflow: m^3/s;
            Sf pump = inflow; 0 tank: hydraulic; C air = capacity start 3; R valve = throttle;
            pump -> tank -> air; tank -> valve;
            observe { pressure: Pa = tank.effort; lost: J = integral(dissipated_power) }
            scene Level { observe { level: m^3 = air.q } tune {} }
        }
    }
}

/// Several models in one place, private, inside a function; the numbers of their states.
fn together() -> [usize; 8] {
    bg_model::bond_graph! {
        graph r { 1 j: translation; I m = 1; j -> m; scene Parameters {} scene Inputs {} scene System {} scene gen {} }
        graph S { 1 j: translation; I m = 1; j -> m; scene F {} scene T {} }
    }
    [r::STATES, Parameters::STATES, Inputs::STATES, System::STATES, r#gen::STATES, S::STATES, F::STATES, T::STATES]
}

/// The rates at the start.
fn rates<const N: usize, const G: usize, const M: usize>(model: &impl Runs<f64, N, G, M>) -> String {
    let start: SVector<f64, N> = model.start().expect("closed");
    let mut rate = SVector::zeros();
    model.rate(0.0, &start, &[false; G], &mut rate);
    format!("{} {:?}", model.description().name, rate.as_slice())
}

#[test]
fn no_name_is_taken() {
    let models = all();
    assert_eq!(models.len(), 33);
    for (name, rates) in models {
        // Of the stretch, of the momentum 1 N - 3 N/m x 0.5 m, of both integrals.
        assert_eq!(rates, format!("{name} [0.0, -0.5, 0.0, 0.5]"));
    }
    let coil = own::Coil::new(own::CoilParameters {}, own::CoilInputs { voltage: 1.0.into() }).expect("in range");
    assert_eq!(rates(&coil), format!("Coil [{:?}]", 1.0 - bg_model::scalar::Scalar::tanh(0.25)));
    let tank =
        bare::Tank::new(bare::TankParameters::default(), bare::TankInputs { inflow: 8.0.into() }).expect("in range");
    assert_eq!(rates(&tank), "Tank [2.0, 72.0]");
    let level = bare::Level::new(bare::LevelParameters {}, bare::LevelInputs { inflow: 8.0.into() }).expect("in range");
    assert_eq!(rates(&level), "Level [2.0]");
    assert_eq!(together(), [1, 0, 0, 0, 0, 1, 0, 0]);
}
