//! The report page of the paper's run: how large it is, and that its numbers are those of the CSV file.

use std::fs;

use assert_cmd::Command;
use bg_workbench::samples;
use serde_json::Value;

#[test]
fn the_page_of_the_paper_s_run_is_small_and_has_the_numbers_of_the_csv_file() {
    let folder = tempfile::tempdir().unwrap();
    Command::cargo_bin("hacksaw").unwrap().current_dir(&folder).args(["report", "--glb"]).assert().success();
    let out = folder.path().join("out");
    let html = fs::read_to_string(out.join("hacksaw.html")).unwrap();
    assert!(html.len() <= 2_000_000, "{} bytes", html.len());
    assert!(fs::metadata(out.join("hacksaw.glb")).unwrap().len() < 500_000);
    let csv = samples::read(fs::File::open(out.join("trajectory.csv")).unwrap()).unwrap();
    let data = html.split_once("id=\"data\">").unwrap().1.split_once("</script>").unwrap().0;
    let data: Value = serde_json::from_str(data).unwrap();
    let value = |series: &Value, k: usize| series.as_f64().or_else(|| series[k].as_f64()).unwrap_or(f64::NAN);

    let rows: Vec<usize> = data["rows"].as_array().unwrap().iter().map(|k| k.as_u64().unwrap() as usize).collect();
    assert_eq!((rows.len(), csv.times.len()), (501, 501));
    let mut columns = 0;
    for curve in data["charts"].as_array().unwrap().iter().flat_map(|chart| chart["curves"].as_array().unwrap()) {
        // The hacksaw's CSV file has the columns of the reference; the page shows all outputs.
        let Some(column) = csv.column(curve["column"].as_str().unwrap()) else { continue };
        columns += 1;
        for (row, &k) in rows.iter().enumerate() {
            assert_eq!(value(&curve["values"], k).to_bits(), column[row].to_bits(), "{}", curve["column"]);
        }
    }
    assert_eq!(columns, csv.columns.len());

    // Bodies 2 to 5 are where the CSV has them, the crank's pin on its circle.
    let motion = &data["animation"];
    let mut seen = 0;
    for (k, t) in motion["times"].as_array().unwrap().iter().enumerate() {
        let Some(row) = csv.times.iter().position(|&time| Some(time) == t.as_f64()) else { continue };
        seen += 1;
        for (body, axis) in (2..6).flat_map(|body| ["x", "y", "z"].map(|axis| (body, axis))) {
            let exact = csv.column(&format!("C{body}_{axis}")).unwrap()[row];
            let shown = value(&motion["bodies"][body - 2]["position"]["xyz".find(axis).unwrap()], k);
            assert!((shown - exact).abs() <= 5e-6 * exact.abs() + 1e-12, "C{body}_{axis} at {t}: {shown}, {exact}");
        }
        let [sine, cosine] = [2, 3].map(|part| value(&motion["bodies"][0]["orientation"][part], k));
        let exact = csv.column("R2_21").unwrap()[row];
        assert!((2.0 * sine * cosine - exact).abs() < 2e-5, "the crank at {t}");
    }
    assert!(seen > 300, "{seen} rows are in the motion");
}
