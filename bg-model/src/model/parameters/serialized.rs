//! Parameters as serde sees them: a struct of numbers by name.
//!
//! In: the names of a parameter struct. Out: what `Serialize` and `Deserialize` of a generated struct do. Unknown and
//! repeated names are refused, missing ones keep their defaults.

use alloc::string::String;
use alloc::vec;
use core::fmt;
use core::marker::PhantomData;

use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::ser::{SerializeStruct, Serializer};

use super::Parameters;

/// Writes `parameters` as the struct `name` with a number for each parameter.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<P: Parameters, S: Serializer>(
    parameters: &P,
    name: &'static str,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let table = P::table();
    let mut fields = serializer.serialize_struct(name, table.len())?;
    for (index, parameter) in table.iter().enumerate() {
        fields.serialize_field(parameter.name, &parameters.value(index))?;
    }
    fields.end()
}

/// Reads the struct `name`, whose fields are `names`, the parameters in the order of the table. Ranges are not checked.
///
/// # Errors
/// Those of the deserializer; a name that is unknown or there twice, a value that is no number.
pub fn deserialize<'de, P: Parameters, D: Deserializer<'de>>(
    name: &'static str,
    names: &'static [&'static str],
    deserializer: D,
) -> Result<P, D::Error> {
    deserializer.deserialize_struct(name, names, Fields { name, names, parameters: PhantomData })
}

struct Fields<P> {
    name: &'static str,
    names: &'static [&'static str],
    parameters: PhantomData<P>,
}

impl<'de, P: Parameters> Visitor<'de> for Fields<P> {
    type Value = P;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "struct {}", self.name)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<P, A::Error> {
        let mut parameters = P::default();
        let mut is_read = vec![false; self.names.len()];
        while let Some(index) = map.next_key_seed(Name(self.names))? {
            if core::mem::replace(&mut is_read[index], true) {
                return Err(A::Error::duplicate_field(self.names[index]));
            }
            parameters.set_value(index, map.next_value()?);
        }
        Ok(parameters)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<P, A::Error> {
        let mut parameters = P::default();
        for index in 0..self.names.len() {
            let Some(value) = values.next_element()? else { return Ok(parameters) };
            parameters.set_value(index, value);
        }
        match values.next_element::<IgnoredAny>()? {
            None => Ok(parameters),
            Some(_) => Err(A::Error::invalid_length(self.names.len() + 1, &self)),
        }
    }
}

/// The name of a parameter; read, its index.
struct Name(&'static [&'static str]);

impl<'de> DeserializeSeed<'de> for Name {
    type Value = usize;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<usize, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Name {
    type Value = usize;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a parameter")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<usize, E> {
        self.0.iter().position(|known| *known == name).ok_or_else(|| E::unknown_field(name, self.0))
    }

    fn visit_bytes<E: Error>(self, name: &[u8]) -> Result<usize, E> {
        self.visit_str(&String::from_utf8_lossy(name))
    }

    /// By number, as formats that pack structs have it.
    fn visit_u64<E: Error>(self, index: u64) -> Result<usize, E> {
        let index = usize::try_from(index).ok().filter(|index| *index < self.0.len());
        index.ok_or_else(|| E::custom("there is no parameter of this number"))
    }
}
