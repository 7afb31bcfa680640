//! Tables as JSON: what files have as CSV, for programs that read the standard output.

use serde_json::{Map, Value};

/// The rows of a CSV text with a head: an object for each, by the columns' names. A cell that is a number is one; an
/// empty one is null.
///
/// # Panics
/// The text is no CSV, which is for the caller to write.
#[must_use]
pub fn rows(csv: &str) -> Value {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let head = reader.headers().expect("a head").clone();
    let cell = |text: &str| match text.parse::<f64>() {
        _ if text.is_empty() => Value::Null,
        Ok(number) => Value::from(number),
        Err(_) => Value::from(text),
    };
    let row = |record: Result<csv::StringRecord, csv::Error>| {
        let record = record.expect("rows of one length");
        let cells = head.iter().zip(&record).map(|(name, text)| (name.to_owned(), cell(text)));
        Value::Object(cells.collect::<Map<String, Value>>())
    };
    reader.records().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_row_is_an_object() {
        let expected =
            json!([{ "name": "a, b", "value": 0.5, "of": null }, { "name": "c", "value": -2.0, "of": "NaN?" }]);
        assert_eq!(rows("name,value,of\n\"a, b\",0.5,\nc,-2,NaN?\n"), expected);
        assert_eq!(rows("x\nNaN\n"), json!([{ "x": null }]));
    }
}
