//! Whole numbers in brackets: `link[i - 1].bar`.
//!
//! In: a name as text, the numbers of the indices around it. Out: the same with digits in its brackets, or the word
//! that is no number. An index is a sum of products of digits and indices, which the parser has brought into one form.

/// The indices around a statement with their numbers, the innermost last.
pub(super) type Indices = [(String, i64)];

/// The name with the numbers of its brackets.
///
/// # Errors
/// The first word that is no index.
pub(super) fn evaluated(name: &str, indices: &Indices) -> Result<String, String> {
    let mut parts = name.split('[');
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (inside, rest) = part.split_once(']').unwrap_or((part, ""));
        text += &format!("[{}]{rest}", number(inside, indices)?);
    }
    Ok(text)
}

/// The number of an expression such as `2 * i - 1`.
///
/// # Errors
/// The first word that is no index.
pub(super) fn number(expression: &str, indices: &Indices) -> Result<i64, String> {
    let (mut sum, mut sign) = (0_i64, 1);
    let mut product = None;
    let mut words = expression.split(' ');
    while let Some(word) = words.next() {
        match word {
            "*" => product = Some(product.unwrap_or(1) * factor(words.next().unwrap_or_default(), indices)?),
            "+" | "-" => {
                sum += sign * product.take().unwrap_or(0);
                sign = if word == "-" { -1 } else { 1 };
            }
            _ => product = Some(factor(word, indices)?),
        }
    }
    Ok(sum + sign * product.unwrap_or(0))
}

fn factor(word: &str, indices: &Indices) -> Result<i64, String> {
    let named = indices.iter().rev().find(|(name, _)| name == word);
    // Digits that are too many for any array are as good as those of the last one there could be.
    let digits = || word.bytes().all(|b| b.is_ascii_digit()).then(|| word.parse::<i32>().unwrap_or(i32::MAX).into());
    named.map(|(_, number)| *number).or_else(digits).ok_or_else(|| word.to_owned())
}

/// The arrays that a name goes through, each with its number: `a[1].b[2].c` gives (`a`, 1) and (`a[1].b`, 2). What is
/// no number is left out.
pub(super) fn elements(name: &str) -> impl Iterator<Item = (&str, i64)> {
    name.match_indices('[').filter_map(|(at, _)| {
        let inside = name[at + 1..].split(']').next()?;
        Some((&name[..at], inside.parse().ok()?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_bind_before_sums_and_the_innermost_index_counts() {
        let indices = [("i".to_owned(), 7), ("j".to_owned(), 3), ("i".to_owned(), 2)];
        for (text, value) in [("4", 4), ("i", 2), ("i - 3", -1), ("2 * i + j", 7), ("j * j - 2 * i - 1", 4)] {
            assert_eq!(number(text, &indices), Ok(value), "{text}");
        }
        assert_eq!(number("i + k", &indices), Err("k".to_owned()));
    }

    #[test]
    fn all_brackets_of_a_name_become_digits() {
        let indices = [("i".to_owned(), 2)];
        assert_eq!(evaluated("a[i + 1].b[0].c", &indices), Ok("a[3].b[0].c".to_owned()));
        assert_eq!(evaluated("plain.x", &indices), Ok("plain.x".to_owned()));
        assert_eq!(elements("a[3].b[0].c").collect::<Vec<_>>(), [("a", 3), ("a[3].b", 0)]);
        assert_eq!(elements("a[-1]").collect::<Vec<_>>(), [("a", -1)]);
    }
}
