//! Tables as Parquet files: one row group, a page for each column.
//!
//! In: columns of numbers and texts, texts about them. Out: the file's bytes, and from these the same again. Numbers
//! are exact; a real number that is none is null. Metadata are those of `polars-parquet-format`; pages are written
//! here, for they are short: the values one after the other (`PLAIN`, which every reader has), compressed by Snappy; of
//! real numbers before them which are there (definition levels, `RLE`). Source: Apache Parquet, "File Format" and
//! "Encodings", parquet.apache.org/docs/file-format.

use std::io;

use polars_parquet_format::thrift::protocol::{TCompactInputProtocol, TCompactOutputProtocol};
use polars_parquet_format::{
    ColumnChunk, ColumnMetaData, CompressionCodec, ConvertedType, DataPageHeader, Encoding, FieldRepetitionType,
    FileMetaData, KeyValue, LogicalType, PageHeader, PageType, RowGroup, SchemaElement, StringType, Type,
};
use thiserror::Error;

const MAGIC: &[u8; 4] = b"PAR1";
/// Length of the metadata and [`MAGIC`], at the end of a file.
const TAIL: usize = 8;

/// Values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Real numbers; not a number where there is no value, which is null in the file.
    Real(Vec<f64>),
    /// Texts.
    Text(Vec<String>),
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its values, one for each row.
    pub values: Values,
}

/// Columns of the same length, and what is said of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The columns.
    pub columns: Vec<Column>,
    /// Texts by name, in the file's metadata.
    pub texts: Vec<(String, String)>,
}

/// Bytes that are no table as it is written here.
#[derive(Debug, Error)]
pub enum ParquetError {
    /// The file is cut, or is none.
    #[error("it is cut, or no Parquet file")]
    Cut,
    /// The metadata cannot be read.
    #[error("its metadata: {0}")]
    Metadata(#[from] polars_parquet_format::thrift::Error),
    /// The values cannot be read.
    #[error("its values: {0}")]
    Snappy(#[from] snap::Error),
    /// It is Parquet of another writer.
    #[error("another program wrote it")]
    Foreign,
}

impl Values {
    /// How many.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Whole(values) => values.len(),
            Self::Real(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    const fn kind(&self) -> Type {
        match self {
            Self::Whole(_) => Type::INT64,
            Self::Real(_) => Type::DOUBLE,
            Self::Text(_) => Type::BYTE_ARRAY,
        }
    }

    /// A page's bytes, not yet compressed.
    fn encoded(&self) -> Vec<u8> {
        match self {
            Self::Whole(values) => values.iter().flat_map(|value| value.to_le_bytes()).collect(),
            Self::Real(values) => {
                let levels = levels(values);
                let there = values.iter().filter(|value| !value.is_nan()).flat_map(|value| value.to_le_bytes());
                (levels.len() as u32).to_le_bytes().into_iter().chain(levels).chain(there).collect()
            }
            Self::Text(values) => {
                let text = |value: &String| [&(value.len() as u32).to_le_bytes(), value.as_bytes()].concat();
                values.iter().flat_map(text).collect()
            }
        }
    }

    /// The values of a page with `count` of them.
    fn decoded(kind: Type, bytes: &[u8], count: usize) -> Result<Self, ParquetError> {
        match kind {
            Type::INT64 if bytes.len() == 8 * count => Ok(Self::Whole(words(bytes).map(i64::from_le_bytes).collect())),
            Type::DOUBLE => {
                let (length, rest) = bytes.split_first_chunk().ok_or(ParquetError::Cut)?;
                let length = u32::from_le_bytes(*length) as usize;
                let (levels, rest) = rest.split_at_checked(length).ok_or(ParquetError::Cut)?;
                let are_there = are_there(levels, count)?;
                if rest.len() != 8 * are_there.iter().filter(|is_there| **is_there).count() {
                    return Err(ParquetError::Foreign);
                }
                let mut there = words(rest).map(f64::from_le_bytes);
                let value = |is_there: bool| if is_there { there.next().unwrap_or(f64::NAN) } else { f64::NAN };
                Ok(Self::Real(are_there.into_iter().map(value).collect()))
            }
            Type::BYTE_ARRAY => {
                let mut rest = bytes;
                let mut text = || {
                    let (length, after) = rest.split_first_chunk().ok_or(ParquetError::Cut)?;
                    let length = u32::from_le_bytes(*length) as usize;
                    let (text, after) = after.split_at_checked(length).ok_or(ParquetError::Cut)?;
                    rest = after;
                    Ok(String::from_utf8_lossy(text).into_owned())
                };
                Ok(Self::Text((0..count).map(|_| text()).collect::<Result<_, ParquetError>>()?))
            }
            _ => Err(ParquetError::Foreign),
        }
    }
}

/// Numbers of eight bytes.
fn words(bytes: &[u8]) -> impl Iterator<Item = [u8; 8]> {
    bytes.chunks_exact(8).map(|word| word.try_into().expect("eight bytes"))
}

/// Which numbers are there, as runs: the length of each, twice, in groups of seven bits, then 1 or 0.
fn levels(values: &[f64]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for run in values.chunk_by(|a, b| a.is_nan() == b.is_nan()) {
        let mut length = run.len() << 1;
        while length >= 0x80 {
            bytes.push(length as u8 | 0x80);
            length >>= 7;
        }
        bytes.extend([length as u8, u8::from(!run[0].is_nan())]);
    }
    bytes
}

/// The same read back, of `count` numbers.
fn are_there(levels: &[u8], count: usize) -> Result<Vec<bool>, ParquetError> {
    let mut found = Vec::with_capacity(count);
    let mut bytes = levels.iter();
    while found.len() < count {
        let (mut length, mut shift) = (0_usize, 0);
        loop {
            let byte = *bytes.next().ok_or(ParquetError::Cut)?;
            length |= usize::from(byte & 0x7f).checked_shl(shift).ok_or(ParquetError::Foreign)?;
            shift += 7;
            if byte & 0x80 == 0 {
                break;
            }
        }
        let level = *bytes.next().ok_or(ParquetError::Cut)?;
        // Others may pack single bits, and so say by an odd number.
        if length & 1 != 0 || level > 1 || (length >> 1) > count - found.len() {
            return Err(ParquetError::Foreign);
        }
        found.resize(found.len() + (length >> 1), level == 1);
    }
    Ok(found)
}

impl Table {
    /// The file.
    ///
    /// # Panics
    /// The columns are not of one length, or a page is longer than 2 GB.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        let rows = self.columns.first().map_or(0, |column| column.values.len());
        let mut file = MAGIC.to_vec();
        let chunks: Vec<ColumnChunk> = self.columns.iter().map(|column| chunk(&mut file, column, rows)).collect();
        let of = |size: fn(&ColumnMetaData) -> i64| {
            chunks.iter().filter_map(|chunk| chunk.meta_data.as_ref()).map(size).sum()
        };
        let group = RowGroup {
            total_byte_size: of(|column| column.total_uncompressed_size),
            total_compressed_size: Some(of(|column| column.total_compressed_size)),
            num_rows: rows as i64,
            sorting_columns: None,
            file_offset: Some(MAGIC.len() as i64),
            ordinal: Some(0),
            columns: chunks,
        };
        let texts = self.texts.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone()));
        let metadata = FileMetaData {
            version: 2,
            schema: self.schema(),
            num_rows: rows as i64,
            row_groups: vec![group],
            key_value_metadata: Some(texts.collect()),
            created_by: Some(concat!("bg-workbench version ", env!("CARGO_PKG_VERSION")).to_owned()),
            column_orders: None,
            encryption_algorithm: None,
            footer_signing_key_metadata: None,
        };
        let start = file.len();
        metadata.write_to_out_protocol(&mut TCompactOutputProtocol::new(&mut file)).expect("memory takes all bytes");
        let length = u32::try_from(file.len() - start).expect("metadata are below 4 GB");
        file.extend(length.to_le_bytes());
        file.extend(MAGIC);
        file
    }

    fn schema(&self) -> Vec<SchemaElement> {
        let element = |name: &str, children: Option<i32>, kind: Option<Type>| {
            let is_text = kind == Some(Type::BYTE_ARRAY);
            let repetition = |kind: Type| {
                if kind == Type::DOUBLE { FieldRepetitionType::OPTIONAL } else { FieldRepetitionType::REQUIRED }
            };
            SchemaElement {
                type_: kind,
                type_length: None,
                repetition_type: kind.map(repetition),
                name: name.to_owned(),
                num_children: children,
                converted_type: is_text.then_some(ConvertedType::UTF8),
                scale: None,
                precision: None,
                field_id: None,
                logical_type: is_text.then_some(LogicalType::STRING(StringType {})),
            }
        };
        let count = i32::try_from(self.columns.len()).expect("columns can be counted");
        let columns = self.columns.iter().map(|column| element(&column.name, None, Some(column.values.kind())));
        std::iter::once(element("runs", Some(count), None)).chain(columns).collect()
    }

    /// The table that is in a file.
    ///
    /// # Errors
    /// [`ParquetError`].
    pub fn read(file: &[u8]) -> Result<Self, ParquetError> {
        let metadata = metadata(file)?;
        let [group] = &metadata.row_groups[..] else { return Err(ParquetError::Foreign) };
        let chunks = group.columns.iter().map(|chunk| chunk.meta_data.as_ref().ok_or(ParquetError::Foreign));
        let columns = chunks.map(|chunk| column(file, chunk?)).collect::<Result<_, _>>()?;
        Ok(Self { columns, texts: texts(metadata) })
    }

    /// Writes its rows as CSV: every number in the shortest form that reads back to the same bits, nothing where there
    /// is none.
    ///
    /// # Errors
    /// `csv` fails.
    pub fn write_rows(&self, csv: &mut csv::Writer<impl io::Write>) -> io::Result<()> {
        let rows = self.columns.first().map_or(0, |column| column.values.len());
        for row in 0..rows {
            let field = |values: &Values| match values {
                Values::Whole(values) => values[row].to_string(),
                Values::Real(values) if values[row].is_nan() => String::new(),
                Values::Real(values) => format!("{:?}", values[row]),
                Values::Text(values) => values[row].clone(),
            };
            csv.write_record(self.columns.iter().map(|column| field(&column.values)))?;
        }
        Ok(())
    }

    /// It as CSV, with the names of its columns in the first line.
    ///
    /// # Panics
    /// Memory does not take it.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = csv::Writer::from_writer(Vec::new());
        let names = self.columns.iter().map(|column| column.name.as_str());
        let written = csv.write_record(names).map_err(io::Error::from).and_then(|()| self.write_rows(&mut csv));
        written.expect("memory takes all");
        String::from_utf8(csv.into_inner().expect("memory takes all")).expect("fields are text")
    }

    /// Appends the rows of a table with the same columns; a table without columns becomes that one.
    pub fn append(&mut self, more: Self) {
        if self.columns.is_empty() {
            *self = more;
            return;
        }
        for (column, more) in self.columns.iter_mut().zip(more.columns) {
            match (&mut column.values, more.values) {
                (Values::Whole(values), Values::Whole(more)) => values.extend(more),
                (Values::Real(values), Values::Real(more)) => values.extend(more),
                (Values::Text(values), Values::Text(more)) => values.extend(more),
                _ => {}
            }
        }
    }
}

fn texts(metadata: FileMetaData) -> Vec<(String, String)> {
    let texts = metadata.key_value_metadata.unwrap_or_default().into_iter();
    texts.map(|text| (text.key, text.value.unwrap_or_default())).collect()
}

/// Appends a column's page to `file`.
fn chunk(file: &mut Vec<u8>, column: &Column, rows: usize) -> ColumnChunk {
    assert_eq!(column.values.len(), rows, "`{}` has a value for each row", column.name);
    let (kind, encoding) = (column.values.kind(), Encoding::PLAIN);
    let plain = column.values.encoded();
    let compressed = snap::raw::Encoder::new().compress_vec(&plain).expect("a page is below 4 GB");
    let size = |bytes: &[u8]| i32::try_from(bytes.len()).expect("a page is below 2 GB");
    let start = file.len();
    let header = PageHeader {
        type_: PageType::DATA_PAGE,
        uncompressed_page_size: size(&plain),
        compressed_page_size: size(&compressed),
        crc: Some(rawzip::crc32(&compressed).cast_signed()),
        data_page_header: Some(DataPageHeader::new(rows as i32, encoding, Encoding::RLE, Encoding::RLE, None)),
        index_page_header: None,
        dictionary_page_header: None,
        data_page_header_v2: None,
    };
    header.write_to_out_protocol(&mut TCompactOutputProtocol::new(&mut *file)).expect("memory takes all bytes");
    let head = file.len() - start;
    file.extend(&compressed);
    let metadata = ColumnMetaData {
        type_: kind,
        encodings: vec![encoding, Encoding::RLE],
        path_in_schema: vec![column.name.clone()],
        codec: CompressionCodec::SNAPPY,
        num_values: rows as i64,
        total_uncompressed_size: (head + plain.len()) as i64,
        total_compressed_size: (head + compressed.len()) as i64,
        key_value_metadata: None,
        data_page_offset: start as i64,
        index_page_offset: None,
        dictionary_page_offset: None,
        statistics: None,
        encoding_stats: None,
        bloom_filter_offset: None,
        bloom_filter_length: None,
        size_statistics: None,
    };
    ColumnChunk {
        file_path: None,
        file_offset: start as i64,
        meta_data: Some(metadata),
        offset_index_offset: None,
        offset_index_length: None,
        column_index_offset: None,
        column_index_length: None,
        crypto_metadata: None,
        encrypted_column_metadata: None,
    }
}

/// The metadata at the end of a file that is not cut: its pages fill what is in front of them.
fn metadata(file: &[u8]) -> Result<FileMetaData, ParquetError> {
    let body = file.strip_prefix(MAGIC).and_then(|file| file.strip_suffix(MAGIC)).ok_or(ParquetError::Cut)?;
    let (body, length) = body.split_last_chunk().ok_or(ParquetError::Cut)?;
    let length = u32::from_le_bytes(*length) as usize;
    let start = body.len().checked_sub(length).ok_or(ParquetError::Cut)?;
    // The reader asks for a limit of what it allocates; names and texts are longer in memory than in the file.
    let most = 64 * length + 4096;
    let metadata = FileMetaData::read_from_in_protocol(&mut TCompactInputProtocol::new(&body[start..], most))?;
    let pages: i64 = metadata.row_groups.iter().filter_map(|group| group.total_compressed_size).sum();
    if pages == start as i64 { Ok(metadata) } else { Err(ParquetError::Cut) }
}

/// A column read back.
fn column(file: &[u8], chunk: &ColumnMetaData) -> Result<Column, ParquetError> {
    let name = chunk.path_in_schema.first().ok_or(ParquetError::Foreign)?.clone();
    let place = |offset: i64| usize::try_from(offset).map_err(|_| ParquetError::Foreign);
    let [start, size, count] = [chunk.data_page_offset, chunk.total_compressed_size, chunk.num_values].map(place);
    let pages = file.get(start?..).and_then(|file| file.get(..size.ok()?)).ok_or(ParquetError::Cut)?;
    let mut rest = pages;
    let header = PageHeader::read_from_in_protocol(&mut TCompactInputProtocol::new(&mut rest, 64 * TAIL + 4096))?;
    if header.crc.is_none_or(|crc| crc.cast_unsigned() != rawzip::crc32(rest)) {
        return Err(ParquetError::Cut);
    }
    let encoding = header.data_page_header.as_ref().map(|header| header.encoding);
    if encoding != Some(Encoding::PLAIN) {
        return Err(ParquetError::Foreign);
    }
    let plain = snap::raw::Decoder::new().decompress_vec(rest)?;
    Ok(Column { name, values: Values::decoded(chunk.type_, &plain, count?)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let columns = [
            ("run", Values::Whole(vec![0, -1, i64::MAX])),
            ("x", Values::Real(vec![1.0 / 3.0, -0.0, f64::INFINITY])),
            ("reason", Values::Text(vec![String::new(), "no step of 1\u{B5}s".to_owned(), "x".to_owned()])),
        ];
        let columns = columns.map(|(name, values)| Column { name: name.to_owned(), values });
        Table { columns: columns.to_vec(), texts: vec![("plan".to_owned(), "a\nb".to_owned())] }
    }

    #[test]
    fn a_table_reads_back() {
        let bytes = table().bytes();
        assert_eq!(Table::read(&bytes).unwrap(), table());
        let mut twice = Table::default();
        twice.append(table());
        twice.append(table());
        assert_eq!(twice.columns[0].values, Values::Whole([0, -1, i64::MAX].repeat(2)));
        let empty =
            Table { columns: vec![Column { name: "x".to_owned(), values: Values::Real(vec![]) }], texts: vec![] };
        assert_eq!(Table::read(&empty.bytes()).unwrap(), empty);
    }

    #[test]
    fn numbers_that_are_none_stay_none_wherever_they_are() {
        let long = [vec![f64::NAN; 3], vec![1.5; 100], vec![f64::NAN; 70_000], vec![-2.0], vec![f64::NAN]].concat();
        for values in [vec![f64::NAN; 2], vec![f64::NAN, 0.0], long] {
            let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            let expected = bits(&values);
            let column = Column { name: "x".to_owned(), values: Values::Real(values) };
            let read = Table::read(&Table { columns: vec![column], texts: vec![] }.bytes()).unwrap();
            let Values::Real(read) = &read.columns[0].values else { panic!("real numbers") };
            assert_eq!(bits(read), expected);
        }
    }

    #[test]
    fn a_file_that_is_cut_anywhere_or_has_a_flipped_bit_is_no_table() {
        let bytes = table().bytes();
        for length in 0..bytes.len() {
            assert!(Table::read(&bytes[..length]).is_err(), "{length}");
        }
        let mut flipped = bytes;
        flipped[40] ^= 1;
        assert!(Table::read(&flipped).is_err());
        assert!(Table::read(b"PAR1PAR1").is_err());
    }
}
