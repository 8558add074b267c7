use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float32Type, Float64Type, Int32Type, Int64Type, UInt32Type};
use arrow_array::{Array, ArrayRef, DictionaryArray, Float64Array, RecordBatch, StringArray, UInt32Array};
use arrow_schema::{ArrowError, DataType, Field, Schema as ArrowSchema, SchemaRef};
use sophy_record::{ColumnKind, Metadata, Schema, Table};

use crate::columns::{Cells, Labels};

/// Our columns in Arrow's words.
pub(super) fn arrow_schema(schema: &Schema, metadata: &Metadata) -> SchemaRef {
    let field = |name: &str, kind: DataType, unit: Option<&str>| {
        let unit = unit.map(|unit| ("unit".to_owned(), unit.to_owned()));
        Field::new(name, kind, false).with_metadata(HashMap::from_iter(unit))
    };
    let mut fields = vec![field("time", DataType::Float64, Some("s"))];
    if schema.with_step {
        fields.push(field("step", DataType::UInt32, None));
    }
    for column in &schema.columns {
        let kind = match column.kind {
            ColumnKind::Real => DataType::Float64,
            ColumnKind::Label(_) => {
                DataType::Dictionary(Box::new(DataType::UInt32), Box::new(DataType::Utf8))
            }
        };
        fields.push(field(&column.name, kind, column.unit.as_deref()));
    }
    let metadata: HashMap<String, String> = metadata.entries.clone().into_iter().collect();
    Arc::new(ArrowSchema::new_with_metadata(fields, metadata))
}

/// The names of each label column. Made once: a stream repeats a dictionary only if it changed.
pub(super) fn dictionaries(schema: &Schema) -> Vec<ArrayRef> {
    let names = schema.columns.iter().filter_map(|column| match &column.kind {
        ColumnKind::Label(names) => Some(Arc::new(StringArray::from_iter_values(names)) as ArrayRef),
        ColumnKind::Real => None,
    });
    names.collect()
}

/// Moves the rows of `table` into a batch and leaves it empty.
pub(super) fn take_batch(
    table: &mut Table,
    schema: &SchemaRef,
    dictionaries: &[ArrayRef],
) -> Result<RecordBatch, ArrowError> {
    // The next batch will be about as long.
    let rows = table.len();
    let real = |values: &mut Vec<f64>| {
        let values = std::mem::replace(values, Vec::with_capacity(rows));
        Arc::new(Float64Array::from(values)) as ArrayRef
    };
    let mut arrays = vec![real(&mut table.time)];
    if table.schema.with_step {
        arrays.push(Arc::new(UInt32Array::from(std::mem::take(&mut table.step))));
    }
    let mut reals = table.reals.iter_mut().map(real);
    let mut labels = table.labels.iter_mut().zip(dictionaries);
    for column in &table.schema.columns {
        match column.kind {
            ColumnKind::Real => arrays.extend(reals.next()),
            ColumnKind::Label(_) => {
                let Some((positions, names)) = labels.next() else { continue };
                let keys = UInt32Array::from(std::mem::take(positions));
                arrays.push(Arc::new(DictionaryArray::<UInt32Type>::try_new(keys, names.clone())?));
            }
        }
    }
    RecordBatch::try_new(schema.clone(), arrays)
}

/// Empty cells for an Arrow column; `None` for a type that no result has.
pub(crate) fn cells_for(kind: &DataType) -> Option<Cells> {
    match kind {
        DataType::Float64 | DataType::Float32 | DataType::Int32 | DataType::Int64 | DataType::UInt32 => {
            Some(Cells::Real(Vec::new()))
        }
        DataType::Utf8 | DataType::LargeUtf8 => Some(Cells::Label(Labels::default())),
        DataType::Dictionary(key, value)
            if **value == DataType::Utf8 && matches!(**key, DataType::UInt32 | DataType::Int32) =>
        {
            Some(Cells::Label(Labels::default()))
        }
        _ => None,
    }
}

/// Appends a column of a batch to cells made by [`cells_for`]. A missing number is NaN, a missing text empty.
pub(crate) fn append(cells: &mut Cells, array: &ArrayRef) {
    match cells {
        Cells::Real(values) => append_reals(values, array),
        Cells::Label(labels) => append_labels(labels, array),
    }
}

fn append_reals(values: &mut Vec<f64>, array: &ArrayRef) {
    let nan = f64::NAN;
    if let Some(array) = array.as_primitive_opt::<Float64Type>() {
        match array.null_count() {
            0 => values.extend_from_slice(array.values()),
            _ => values.extend(array.iter().map(|v| v.unwrap_or(nan))),
        }
    } else if let Some(array) = array.as_primitive_opt::<Float32Type>() {
        values.extend(array.iter().map(|v| v.map_or(nan, f64::from)));
    } else if let Some(array) = array.as_primitive_opt::<UInt32Type>() {
        values.extend(array.iter().map(|v| v.map_or(nan, f64::from)));
    } else if let Some(array) = array.as_primitive_opt::<Int32Type>() {
        values.extend(array.iter().map(|v| v.map_or(nan, f64::from)));
    } else if let Some(array) = array.as_primitive_opt::<Int64Type>() {
        values.extend(array.iter().map(|v| v.map_or(nan, |v| v as f64)));
    }
}

fn append_labels(labels: &mut Labels, array: &ArrayRef) {
    if let Some(array) = array.as_dictionary_opt::<UInt32Type>() {
        append_keys(labels, array.values(), array.keys().iter().map(|key| key.map(|key| key as usize)));
    } else if let Some(array) = array.as_dictionary_opt::<Int32Type>() {
        append_keys(labels, array.values(), array.keys().iter().map(|key| key.map(|key| key as usize)));
    } else if let Some(array) = array.as_string_opt::<i32>() {
        array.iter().for_each(|text| labels.push(text.unwrap_or("")));
    } else if let Some(array) = array.as_string_opt::<i64>() {
        array.iter().for_each(|text| labels.push(text.unwrap_or("")));
    }
}

fn append_keys(labels: &mut Labels, names: &ArrayRef, keys: impl Iterator<Item = Option<usize>>) {
    let Some(names) = names.as_string_opt::<i32>() else { return };
    let positions: Vec<u32> = names.iter().map(|name| labels.intern(name.unwrap_or(""))).collect();
    for key in keys {
        match key.and_then(|key| positions.get(key)) {
            Some(&position) => labels.push_position(position),
            None => labels.push(""),
        }
    }
}
