//! Names of a file as names of a graph: identifiers, each once.

use std::collections::BTreeSet;

/// What a name may not be: Rust's keywords, and what the language calls its own things or those of a body or a joint.
const RESERVED: &str = "as break const continue crate else enum extern false fn for if impl in let loop match mod move \
    mut pub ref return self static struct super trait true type unsafe use where while async await dyn abstract become \
    box do final macro override priv typeof unsized virtual yield try gen t ground gravity origin stored_energy \
    supplied_power dissipated_power gravity_field position velocity orientation angle momentum p h mass center tensor \
    moments weight translation rotation linear angular start place attitude x_axis y_axis z_axis angular_velocity \
    angular_momentum kinetic_energy potential energy Self";

/// The names that are taken.
#[derive(Debug)]
pub struct Names(BTreeSet<String>);

impl Default for Names {
    fn default() -> Self {
        Self(RESERVED.split_whitespace().map(str::to_owned).collect())
    }
}

impl Names {
    /// A name that is free, with all that are made of it: the one wanted, else with `ending`, else with a number.
    pub fn take(&mut self, wanted: &str, ending: &str, made: &[&str]) -> String {
        let name = identifier(wanted);
        let numbered = (2..).map(|count| format!("{name}_{count}"));
        let mut choices = [name.clone(), format!("{name}_{ending}")].into_iter().chain(numbered);
        let all = |choice: &str| {
            let made = made.iter().map(|made| format!("{choice}_{made}"));
            [choice.to_owned()].into_iter().chain(made).collect::<Vec<_>>()
        };
        let free = choices.find(|choice| all(choice).iter().all(|name| !self.0.contains(name))).unwrap_or(name);
        self.0.extend(all(&free));
        free
    }
}

/// A text of the file as it may stand in a comment or on a screen: no line break, nothing that cannot be seen.
#[must_use]
pub fn shown(text: &str) -> String {
    let is_seen = |c: char| c == ' ' || !(c.is_control() || c.is_whitespace() || turns_text(c));
    text.chars().map(|c| if is_seen(c) { c.to_string() } else { c.escape_unicode().to_string() }).collect()
}

/// Characters that turn the direction of text, which rustc refuses in comments, or take no place.
fn turns_text(c: char) -> bool {
    matches!(c, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

/// Letters, digits and underscores, with a letter first.
fn identifier(name: &str) -> String {
    let kept: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let trimmed = kept.trim_matches('_');
    match trimmed.chars().next() {
        None => "unnamed".to_owned(),
        Some(first) if first.is_ascii_digit() => format!("n{trimmed}"),
        Some(_) => trimmed.to_owned(),
    }
}

/// A name of a type: words in capitals, `kuka_iiwa` to `KukaIiwa`.
pub fn type_name(name: &str) -> String {
    let words: String = identifier(name)
        .split('_')
        .map(|word| word.chars().take(1).flat_map(char::to_uppercase).chain(word.chars().skip(1)).collect::<String>())
        .collect();
    if words == "Self" { "SelfRobot".to_owned() } else { words }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers_each_once() {
        let mut names = Names::default();
        assert_eq!(names.take("lbr_iiwa-link.1", "body", &[]), "lbr_iiwa_link_1");
        assert_eq!(names.take("lbr_iiwa_link.1", "joint", &[]), "lbr_iiwa_link_1_joint");
        assert_eq!(names.take("lbr_iiwa_link_1", "joint", &[]), "lbr_iiwa_link_1_2");
        assert_eq!(names.take("1st", "body", &[]), "n1st");
        assert_eq!(names.take("mass", "body", &[]), "mass_body");
        assert_eq!(names.take("--", "body", &[]), "unnamed");
        assert_eq!(type_name("kuka-iiwa 7"), "KukaIiwa7");
        assert_eq!((type_name("self").as_str(), type_name("Self").as_str()), ("SelfRobot", "SelfRobot"));
    }

    #[test]
    fn names_that_are_made_of_a_name_are_taken_with_it() {
        let mut names = Names::default();
        assert_eq!(names.take("arm_motor", "body", &[]), "arm_motor");
        assert_eq!(names.take("arm", "joint", &["start", "motor"]), "arm_joint");
        assert_eq!(names.take("arm_joint_start", "body", &[]), "arm_joint_start_body");
    }

    #[test]
    fn what_breaks_a_line_or_cannot_be_seen_is_written_out() {
        assert_eq!(shown("a\nb\r\u{202e}c \u{e9}"), "a\\u{a}b\\u{d}\\u{202e}c \u{e9}");
    }
}
