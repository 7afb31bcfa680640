//! Models that the library makes of a unit's resources.

use std::ffi::{CString, c_char, c_void};
use std::fs;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use bg_fmi::abi::LogMessage;
use bg_fmi::{Exported, Instance, Interface, token};
use bg_loaded::{Bundle, Chosen, Interpreted, Opened};
use bg_model::description::Description;
use bg_model::run::{Request, Simulation};
use bg_model::simulation::Samples;
use bond_fmu::found;

const TEXT: &str = r#"
use "parts/hanger.bond";
graph Pendulum {
    param length: m = 1, above 0; param damping: N*m*s/rad = 0.1; input push: N*m;
    gravity [0, -9.81, 0];
    ground { point pivot = [0, 0, 0]; }
    body rod {
        mass 2; inertia [0.01, 0.2, 0.2]; point end = [-length / 2, 0, 0]; start end at [0, 0, 0];
        start turned rotation_z(-0.5);
    }
    joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
    drive bearing on pin torque = push - damping * pin.speed;
    part hanger: Hanger;
    observe { angle: rad = pin.angle; x: m = hanger.spring.q }
    scene Swing { tune { length } }
}
"#;
const PART: &str = "pub part Hanger {
    param k: N/m = 40, above 0; 1 slide: translation; I body = 3; C spring = k start 0.2; slide -> body; \
    slide -> spring;
}";

/// The text with its part, as if both stood in files.
fn bundle(text: &str) -> Bundle {
    let open = |path: &Path| {
        assert_eq!(path, Path::new("models/parts/hanger.bond"), "from the folder of the text");
        Ok(Opened { file: path.to_owned(), text: PART.to_owned() })
    };
    let first = Opened { file: "models/pendulum.bond".into(), text: text.to_owned() };
    Bundle::gathered(Path::new("models/pendulum.bond"), first, &open)
}

fn chosen(text: &str, model: &str) -> Chosen {
    Chosen { text: bundle(text), graph: "Pendulum".to_owned(), model: model.to_owned(), most: None }
}

/// The resources of a unit of this model.
fn resources(chosen: &Chosen) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join(Chosen::FILE), serde_json::to_vec(chosen).expect("data")).expect("a file");
    folder
}

fn model(chosen: &Chosen) -> &'static dyn Exported {
    let folder = resources(chosen);
    let [model] = found(Some(folder.path().to_owned())).expect("a model")[..] else { panic!("one model") };
    model
}

#[test]
fn a_unit_goes_where_a_run_goes() {
    let chosen = chosen(TEXT, "Pendulum");
    let model = model(&chosen);
    let mut instance = Instance::new(model, Interface::CoSimulation);
    instance.enter_initialization(0.0, Some(1e-9)).expect("a start");
    instance.exit_initialization().expect("a start");
    (0..10).for_each(|k| instance.step(0.1 * f64::from(k), 0.1).expect("a step"));
    let own =
        Rc::new(Interpreted::new(&chosen.blueprint().expect("a model"), &[1.0, 0.1, 40.0], &[]).expect("in range"));
    let request = Request { rtol: 1e-9, t_end: 1.0, samples: Samples::At(vec![1.0]), ..Request::default() };
    let run = Simulation::over(own, request).run().expect("a run");
    let description = model.description();
    for (index, output) in description.outputs.iter().enumerate() {
        let wanted = run.recording.columns[index].values[0];
        let reference = reference(description, index);
        let mut value = [0.0];
        instance.get(&[reference], &mut value).expect("a value");
        assert!((value[0] - wanted).abs() < 1e-8, "{}: {} for {wanted}", output.name, value[0]);
    }
}

/// The value reference of an output: they count through time, parameters, inputs, outputs.
fn reference(description: &Description, output: usize) -> u32 {
    u32::try_from(1 + description.parameters.len() + description.inputs.len() + output).expect("few")
}

unsafe extern "C" {
    fn fmi3InstantiateModelExchange(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        environment: *mut c_void,
        log: LogMessage,
    ) -> *mut c_void;
    fn fmi3FreeInstance(instance: *mut c_void);
}

/// As a host calls the library: the functions of the standard find the model by the folder of the resources.
#[test]
fn a_host_gets_an_instance() {
    let chosen = chosen(TEXT, "Pendulum");
    let folder = resources(&chosen);
    let text = |text: &str| CString::new(text).expect("a text");
    let (own, other) = (text(&token(model(&chosen).described())), text("{another}"));
    let path = text(folder.path().to_str().expect("a path"));
    let instance = |token: &CString, resources: *const c_char| {
        // SAFETY: texts that end with 0, or none; nothing is logged.
        unsafe {
            fmi3InstantiateModelExchange(
                c"own".as_ptr(),
                token.as_ptr(),
                resources,
                false,
                false,
                std::ptr::null_mut(),
                None,
            )
        }
    };
    let pointer = instance(&own, path.as_ptr());
    assert!(
        !pointer.is_null() && instance(&other, path.as_ptr()).is_null() && instance(&own, std::ptr::null()).is_null()
    );
    // SAFETY: an instance that is used no more.
    unsafe { fmi3FreeInstance(pointer) };
}

#[test]
fn a_scene_is_a_model_of_its_own_and_each_is_made_once() {
    let [graph, scene] = ["Pendulum", "Swing"].map(|name| chosen(TEXT, name));
    let [first, again, other] = [&graph, &graph, &scene].map(model);
    assert!(std::ptr::addr_eq(first, again) && !std::ptr::addr_eq(first, other));
    assert_ne!(token(first.described()), token(other.described()));
}

#[test]
fn what_cannot_be_made_is_said() {
    let fault = |resources: Option<PathBuf>| found(resources).err().expect("no model");
    assert!(fault(None).contains("does not say where the resources"));
    let empty = tempfile::tempdir().expect("a folder");
    assert!(fault(Some(empty.path().to_owned())).contains("cannot read"));
    fs::write(empty.path().join(Chosen::FILE), "{").expect("a file");
    assert!(fault(Some(empty.path().to_owned())).contains("model.json"));
    let broken = resources(&chosen(&TEXT.replace("param damping", "param dampin"), "Pendulum"));
    assert!(fault(Some(broken.path().to_owned())).contains("BG0303"), "{}", fault(Some(broken.path().to_owned())));
    let nobody = resources(&chosen(TEXT, "Nobody"));
    assert!(fault(Some(nobody.path().to_owned())).contains("no model `Nobody`"));
}
