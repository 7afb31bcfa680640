//! Parameters by name, from a file and from `--set`, on the table of the hacksaw.

use bg_model::parameters::Parameters;
use bg_workbench::parameters::{Chosen, SettingError, Values, merge, number, to_toml};
use hacksaw::mechanism::HacksawParameters;

fn chosen(toml: &str, settings: &[&str]) -> Result<Chosen, SettingError> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), toml).unwrap();
    let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
    merge(HacksawParameters::table(), Some(file.path()), &settings)
}

fn merge_text(toml: &str, settings: &[&str]) -> Result<Values, SettingError> {
    chosen(toml, settings).map(|chosen| chosen.values)
}

fn fault(toml: &str, settings: &[&str]) -> String {
    merge_text(toml, settings).unwrap_err().to_string()
}

#[test]
fn a_file_beats_defaults_and_a_setting_beats_the_file() {
    let parameters = merge_text("torque = 12\nr_cut = 80.5\n", &["torque=14", "torque=15"]).unwrap();
    assert_eq!(parameters.get("torque"), Some(15.0));
    assert_eq!(parameters.get("r_cut"), Some(80.5));
    assert_eq!(parameters.get("r_return"), HacksawParameters::default().get("r_return"));
}

#[test]
fn the_last_place_that_set_a_parameter_is_known() {
    let chosen = chosen("torque = 12\nr_cut = 80.5\n", &["torque=14", "torque=15"]).unwrap();
    let place =
        |name: &str| &chosen.places[HacksawParameters::table().iter().position(|info| info.name == name).unwrap()];
    assert_eq!(place("torque"), "--set torque=15");
    assert!(!place("r_cut").is_empty());
    assert_eq!(place("r_return"), "");
}

#[test]
fn each_fault_is_one_line_that_names_its_place() {
    assert_eq!(fault("", &["torqe=1"]), "--set torqe=1: there is no parameter `torqe`; did you mean `torque`?");
    assert_eq!(fault("", &["zzz=1"]), "--set zzz=1: there is no parameter `zzz`; the command `parameters` lists them");
    assert!(fault("", &["k_23=-1"]).starts_with("--set k_23=-1: parameter `k_23` = -1 N/m is out of range"));
    assert!(fault("", &["torque=NaN"]).contains("a finite number"));
    assert!(fault("", &["torque=ten"]).ends_with("must be a number, and `ten` is none"));
    assert!(fault("", &["torque"]).contains("NAME=VALUE"));
    assert!(fault("torqe = 1", &[]).contains("did you mean `torque`?"));
    assert!(fault("torque = nan", &[]).contains("a finite number"));
    assert!(fault("torque = 'ten'", &[]).contains("must be a number"));
    assert!(fault("torque = 1\ntorque = = 2", &[]).contains("line 2, column 10"));
    assert!(fault("[torque]\nx = 1", &[]).contains("must be a number"));
    let cases = [
        ("torqe = 1", &[][..]),
        ("a = [1,\n2", &[]),
        ("\"a\\nb\" = 1", &[]),
        ("", &["k_2=-1"]),
        ("", &["zzz\n = 1"]),
        ("", &["torque=1\r2"]),
    ];
    for (toml, settings) in cases {
        assert!(!fault(toml, settings).contains('\n'));
    }
}

#[test]
fn the_written_file_reads_back() {
    let mut parameters = Values::new(HacksawParameters::table());
    parameters.set("torque", 1.0 / 3.0).unwrap();
    let back = merge_text(&to_toml(&parameters), &[]).unwrap();
    assert_eq!(back, parameters);
}

#[test]
fn numbers_as_written_by_a_person() {
    assert_eq!(number(1e7), "1e7");
    assert_eq!(number(9.81), "9.81");
    assert_eq!(number(7850.0), "7850");
}
