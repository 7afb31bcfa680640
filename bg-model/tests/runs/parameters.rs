//! A generated parameter struct is one that serde can write and read.

use bg_model::bond_graph;

bond_graph! {
    graph Slide {
        param mass: kg = 2, above 0;
        param damping: N*s/m = 0.5;
        param gen: N = 1;
        1 slide: translation; I m = mass; R r = damping; Se f = gen; f -> slide -> m; slide -> r;
    }
}

fn read(text: &str) -> Result<SlideParameters, String> {
    serde_json::from_str(text).map_err(|fault| fault.to_string())
}

#[test]
fn what_is_written_can_be_read() {
    let parameters = SlideParameters { mass: 3.0, damping: 0.1, r#gen: -2.5e-7 };
    let text = serde_json::to_string(&parameters).expect("numbers can be written");
    assert_eq!(text, r#"{"mass":3.0,"damping":0.1,"gen":-2.5e-7}"#);
    assert_eq!(read(&text), Ok(parameters));
}

#[test]
fn what_is_left_out_has_its_default() {
    assert_eq!(read("{}"), Ok(SlideParameters::default()));
    assert_eq!(read(r#"{ "damping": 4 }"#), Ok(SlideParameters { damping: 4.0, ..SlideParameters::default() }));
    assert_eq!(read("[7]"), Ok(SlideParameters { mass: 7.0, ..SlideParameters::default() }));
}

#[test]
fn what_does_not_fit_is_refused_with_its_place() {
    for (text, message) in [
        (r#"{ "mas": 1 }"#, "unknown field `mas`, expected one of `mass`, `damping`, `gen` at line 1 column 7"),
        (r#"{ "mass": 1, "mass": 2 }"#, "duplicate field `mass` at line 1 column 19"),
        (r#"{ "mass": "heavy" }"#, "invalid type: string \"heavy\", expected f64 at line 1 column 17"),
        ("[1, 2, 3, 4]", "invalid length 4, expected struct SlideParameters at line 1 column 12"),
        ("3", "invalid type: integer `3`, expected struct SlideParameters at line 1 column 1"),
    ] {
        assert_eq!(read(text), Err(message.to_owned()), "{text}");
    }
}
