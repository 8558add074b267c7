use super::scope::Numbers;
use super::typed::Shape;
use crate::units::Measured;
use sophy_ir::Quantity;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Constants of a file by name, nested as they are there.
#[derive(Clone, Debug, Default)]
pub(crate) struct Record {
    pub(crate) entries: BTreeMap<String, Entry>,
}

/// A constant of a record.
#[derive(Clone, Debug)]
pub(crate) enum Entry {
    Numbers(Numbers),
    Text(String),
    Record(Rc<Record>),
    /// An array of tables.
    List(Rc<[Rc<Record>]>),
    /// What expressions cannot use, and why.
    Unusable(&'static str),
}

impl From<&toml::Table> for Record {
    fn from(table: &toml::Table) -> Self {
        Record { entries: table.iter().map(|(name, value)| (name.clone(), Entry::from(value))).collect() }
    }
}

impl From<&toml::Value> for Entry {
    fn from(value: &toml::Value) -> Self {
        use toml::Value as V;
        match value {
            V::Integer(_) | V::Float(_) => numbers(std::slice::from_ref(value), Shape::Scalar),
            V::Boolean(truth) => Entry::Numbers(Numbers {
                elements: vec![f64::from(u8::from(*truth))],
                shape: Shape::Scalar,
                quantity: Quantity::Boolean,
                measured: Measured::Unchecked,
            }),
            V::String(text) => Entry::Text(text.clone()),
            V::Datetime(_) => Entry::Unusable("a date"),
            V::Table(table) => Entry::Record(Rc::new(Record::from(table))),
            V::Array(array) => list(array),
        }
    }
}

fn list(array: &[toml::Value]) -> Entry {
    let tables: Vec<_> = array.iter().filter_map(toml::Value::as_table).collect();
    if !array.is_empty() && tables.len() == array.len() {
        return Entry::List(tables.into_iter().map(|table| Rc::new(Record::from(table))).collect());
    }
    let rows: Vec<_> = array.iter().filter_map(toml::Value::as_array).collect();
    let columns = rows.first().map_or(0, |row| row.len());
    if rows.is_empty() {
        return numbers(array, Shape::Vector(array.len()));
    }
    if rows.len() < array.len() || rows.iter().any(|row| row.len() != columns) {
        return Entry::Unusable("an array whose rows differ in length");
    }
    let elements: Vec<toml::Value> = rows.iter().flat_map(|row| row.iter().cloned()).collect();
    numbers(&elements, Shape::Matrix(rows.len(), columns))
}

fn numbers(values: &[toml::Value], shape: Shape) -> Entry {
    let number = |value: &toml::Value| match value {
        toml::Value::Integer(n) => Some(*n as f64),
        toml::Value::Float(x) if x.is_finite() => Some(*x),
        _ => None,
    };
    let Some(elements) = values.iter().map(number).collect::<Option<Vec<f64>>>() else {
        return Entry::Unusable("an array of other things than finite numbers");
    };
    if elements.is_empty() {
        return Entry::Unusable("an empty array");
    }
    let integer = values.iter().all(toml::Value::is_integer);
    let quantity = if integer { Quantity::Integer } else { Quantity::Real };
    Entry::Numbers(Numbers { elements, shape, quantity, measured: Measured::Unchecked })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_becomes_a_record() {
        let table: toml::Table = "mass = 5\non = true\nname = 'AUV'\nday = 2020-01-01\nmixed = [1, 'a']\n\
            J = [[1, 0.5], [2, 3]]\n[drag]\nx = [1.5, 2]\n[[fin]]\nspan = 3\n[[fin]]\nspan = 4"
            .parse()
            .unwrap();
        let record = Record::from(&table);
        let numbers = |entry: &Entry| match entry {
            Entry::Numbers(n) => (n.elements.clone(), n.shape, n.quantity),
            other => panic!("{other:?}"),
        };
        assert_eq!(numbers(&record.entries["mass"]), (vec![5.0], Shape::Scalar, Quantity::Integer));
        assert_eq!(numbers(&record.entries["on"]), (vec![1.0], Shape::Scalar, Quantity::Boolean));
        assert_eq!(
            numbers(&record.entries["J"]),
            (vec![1.0, 0.5, 2.0, 3.0], Shape::Matrix(2, 2), Quantity::Real)
        );
        let Entry::Record(drag) = &record.entries["drag"] else { panic!() };
        assert_eq!(numbers(&drag.entries["x"]), (vec![1.5, 2.0], Shape::Vector(2), Quantity::Real));
        let Entry::List(fins) = &record.entries["fin"] else { panic!() };
        assert_eq!(numbers(&fins[1].entries["span"]).0, [4.0]);
        assert!(matches!(&record.entries["name"], Entry::Text(name) if name == "AUV"));
        assert!(matches!(record.entries["day"], Entry::Unusable(_)));
        assert!(matches!(record.entries["mixed"], Entry::Unusable(_)));
    }
}
