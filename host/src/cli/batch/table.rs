//! Tables of results: CSV, JSON lines and Parquet, with the same columns.

use super::row::{COLUMNS, REQUIRED, Row, Type};
use anyhow::{Context, Result, bail, ensure};
use bytes::Bytes;
use parquet::basic::Compression;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::record::Field;
use parquet::schema::parser::parse_message_type;
use serde_json::{Map, Value};
use std::path::Path;
use std::sync::Arc;

/// Format of a table, by the extension of its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Format {
    Csv,
    JsonLines,
    Parquet,
}

impl Format {
    pub(super) fn of(path: &Path) -> Result<Self> {
        match path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase().as_str() {
            "csv" => Ok(Self::Csv),
            "jsonl" => Ok(Self::JsonLines),
            "parquet" => Ok(Self::Parquet),
            _ => bail!(
                "{}: the format is unknown; give a file that ends in .parquet, .csv or .jsonl",
                path.display()
            ),
        }
    }

    /// The rows as a file.
    pub(super) fn bytes(self, rows: &[Row]) -> Result<Vec<u8>> {
        match self {
            Self::Csv => csv(rows),
            Self::JsonLines => {
                let line = |row| Ok(serde_json::to_string(row)? + "\n");
                Ok(rows.iter().map(line).collect::<Result<String>>()?.into_bytes())
            }
            Self::Parquet => parquet(rows),
        }
    }
}

/// Reads the rows of a table.
pub(super) fn read(path: &Path) -> Result<Vec<Row>> {
    let at = || path.display().to_string();
    let format = Format::of(path)?;
    let bytes = std::fs::read(path).with_context(|| format!("{}: cannot be read", at()))?;
    let rows = match format {
        Format::Csv => {
            ensure!(bytes.ends_with(b"\n"), "{}: it is cut off: write it again", at());
            csv::Reader::from_reader(&bytes[..]).deserialize().map(|row| Ok(row?)).collect()
        }
        Format::JsonLines => {
            let lines = std::str::from_utf8(&bytes).with_context(at)?.lines();
            lines.map(|line| Ok(serde_json::from_str(line)?)).collect()
        }
        Format::Parquet => read_parquet(bytes),
    };
    rows.with_context(|| format!("{}: is not a table of results", at()))
}

fn csv(rows: &[Row]) -> Result<Vec<u8>> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    // Also without rows.
    writer.write_record(COLUMNS.map(|(name, _)| name))?;
    for row in rows {
        writer.serialize(row)?;
    }
    Ok(writer.into_inner()?)
}

fn parquet(rows: &[Row]) -> Result<Vec<u8>> {
    let mut text = String::from("message pairs {");
    for (place, (name, kind)) in COLUMNS.into_iter().enumerate() {
        let repetition = if place < REQUIRED { "required" } else { "optional" };
        text += &match kind {
            Type::Integer => format!("{repetition} int64 {name};"),
            Type::Number => format!("{repetition} double {name};"),
            Type::Text => format!("{repetition} binary {name} (string);"),
        };
    }
    let schema = Arc::new(parse_message_type(&(text + "}"))?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        .set_created_by(concat!("hangpose ", env!("CARGO_PKG_VERSION")).into());
    let rows: Vec<Value> = rows.iter().map(serde_json::to_value).collect::<Result<_, _>>()?;
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties.build()))?;
    let mut group = writer.next_row_group()?;
    for (place, (name, kind)) in COLUMNS.into_iter().enumerate() {
        let cells: Vec<&Value> = rows.iter().map(|row| &row[name]).filter(|cell| !cell.is_null()).collect();
        let levels: Vec<i16> = rows.iter().map(|row| i16::from(!row[name].is_null())).collect();
        let levels = (place >= REQUIRED).then_some(&levels[..]);
        let column = group.next_column()?.context("each column of the schema has a writer")?;
        match kind {
            Type::Integer => write::<Int64Type>(column, &cells, levels, Value::as_i64),
            Type::Number => write::<DoubleType>(column, &cells, levels, Value::as_f64),
            Type::Text => {
                write::<ByteArrayType>(column, &cells, levels, |cell| cell.as_str().map(ByteArray::from))
            }
        }?;
    }
    group.close()?;
    writer.close()?;
    Ok(bytes)
}

/// Writes a column of cells that are not null. `levels` tell where they are among all, if some may be null.
fn write<T: DataType>(
    mut column: SerializedColumnWriter<'_>,
    cells: &[&Value],
    levels: Option<&[i16]>,
    value: impl Fn(&Value) -> Option<T::T>,
) -> Result<()> {
    let values: Vec<T::T> = cells.iter().filter_map(|cell| value(cell)).collect();
    ensure!(values.len() == cells.len(), "every cell has the type of its column");
    column.typed::<T>().write_batch(&values, levels, None)?;
    Ok(column.close()?)
}

fn read_parquet(bytes: Vec<u8>) -> Result<Vec<Row>> {
    let reader = SerializedFileReader::new(Bytes::from(bytes))?;
    let row = |row: parquet::record::Row| {
        let mut cells = Map::new();
        for (name, field) in row.get_column_iter() {
            let value = match field {
                Field::Null => Value::Null,
                Field::Long(value) => (*value).into(),
                Field::Double(value) => (*value).into(),
                Field::Str(value) => value.as_str().into(),
                other => bail!("the column {name} has values of another type, as {other}"),
            };
            cells.insert(name.clone(), value);
        }
        Ok(serde_json::from_value(cells.into())?)
    };
    reader.get_row_iter(None)?.map(|found| row(found?)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows with a number or a text in every column, with none, and with text that CSV must quote.
    fn rows() -> Vec<Row> {
        let full: Map<String, Value> = COLUMNS
            .into_iter()
            .zip(1_i32..)
            .map(|((name, kind), i)| {
                let value = match kind {
                    Type::Integer => i.into(),
                    Type::Number => (f64::from(i) / 30.0).into(),
                    Type::Text => format!("{name} \"{i}\", é\nsecond line").into(),
                };
                (name.into(), value)
            })
            .collect();
        let full: Row = serde_json::from_value(full.into()).unwrap();
        let empty = serde_json::json!({"pair": 7, "id": "7", "object": "a", "supporter": "b"});
        vec![full, serde_json::from_value(empty).unwrap()]
    }

    #[test]
    fn the_columns_are_the_fields_of_a_row_in_their_order() {
        let text = serde_json::to_string(&rows()[0]).unwrap();
        let places = COLUMNS.map(|(name, _)| text.find(&format!("\"{name}\":")).unwrap());
        assert!(places.is_sorted());
        let value = serde_json::to_value(&rows()[0]).unwrap();
        assert_eq!(value.as_object().unwrap().len(), COLUMNS.len());
        let empty = serde_json::to_value(&rows()[1]).unwrap();
        assert!(COLUMNS.iter().enumerate().all(|(i, (name, _))| empty[name].is_null() == (i >= REQUIRED)));
    }

    #[test]
    fn every_format_gives_the_rows_back() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.csv", "a.jsonl", "a.PARQUET"] {
            let path = folder.path().join(name);
            for rows in [rows(), Vec::new()] {
                let bytes = Format::of(&path).unwrap().bytes(&rows).unwrap();
                std::fs::write(&path, bytes).unwrap();
                assert_eq!(read(&path).unwrap(), rows, "{name}");
            }
        }
    }

    #[test]
    fn other_files_are_no_tables() {
        let folder = tempfile::tempdir().unwrap();
        let message = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            format!("{:#}", read(&path).unwrap_err())
        };
        assert!(message("a.txt", "").contains("ends in .parquet, .csv or .jsonl"));
        for (name, text) in [("a.csv", "a,b\n1,2\n"), ("a.jsonl", "{}\n"), ("a.parquet", "PAR1")] {
            assert!(message(name, text).contains("is not a table of results"), "{name}");
        }
        assert!(message("a.csv", "pair,id,obj").contains("cut off"));
    }
}
