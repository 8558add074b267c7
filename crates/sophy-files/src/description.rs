//! What a table of bare cells does not say: units, kinds, names of locations, texts, metadata. It is the content of
//! `FILE.meta.json` and of the key `sophy.columns` in Parquet.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sophy_record::{ColumnKind, Metadata, Schema};

use crate::FileError;
use crate::path::{beside, write_whole};

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Description {
    #[serde(default)]
    pub(crate) metadata: BTreeMap<String, String>,
    #[serde(default)]
    pub(crate) columns: Vec<ColumnDescription>,
}

/// One column of the file, `time` and `step` included.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ColumnDescription {
    pub(crate) name: String,
    pub(crate) kind: CellKind,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) unit: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) names: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum CellKind {
    Time,
    Step,
    Real,
    Location,
    /// Texts, truth values among them.
    Text,
}

impl CellKind {
    /// Whether cells are texts in the file.
    pub(crate) fn is_label(self) -> bool {
        matches!(self, CellKind::Location | CellKind::Text)
    }
}

/// `FILE.meta.json`.
pub(crate) fn sidecar_path(path: &Path) -> PathBuf {
    beside(path, ".meta.json")
}

impl Description {
    pub(crate) fn new(schema: &Schema, metadata: &Metadata) -> Self {
        let plain = |name: &str, kind, unit: Option<&str>| ColumnDescription {
            name: name.to_owned(),
            kind,
            unit: unit.map(str::to_owned),
            names: Vec::new(),
        };
        let mut columns = vec![plain("time", CellKind::Time, Some("s"))];
        if schema.with_step {
            columns.push(plain("step", CellKind::Step, None));
        }
        for column in &schema.columns {
            let (kind, names) = match &column.kind {
                ColumnKind::Real => (CellKind::Real, Vec::new()),
                ColumnKind::Label(names) if column.is_location() => (CellKind::Location, names.clone()),
                ColumnKind::Label(names) => (CellKind::Text, names.clone()),
            };
            columns.push(ColumnDescription {
                kind,
                names,
                ..plain(&column.name, kind, column.unit.as_deref())
            });
        }
        Description { metadata: metadata.entries.clone(), columns }
    }

    /// Writes `FILE.meta.json` beside `path`.
    pub(crate) fn write_beside(&self, path: &Path) -> Result<(), FileError> {
        let sidecar = sidecar_path(path);
        write_whole(&sidecar, |file| {
            let json = serde_json::to_vec_pretty(self).map_err(FileError::format(&sidecar, "JSON"))?;
            file.write_all(&json).and_then(|()| file.write_all(b"\n")).map_err(FileError::writing(&sidecar))
        })
    }

    /// Reads `FILE.meta.json` beside `path`; `None` if there is none.
    pub(crate) fn read_beside(path: &Path) -> Result<Option<Self>, FileError> {
        let sidecar = sidecar_path(path);
        match fs::read(&sidecar) {
            Ok(json) => Ok(Some(serde_json::from_slice(&json).map_err(FileError::format(&sidecar, "JSON"))?)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(FileError::reading(&sidecar)(error)),
        }
    }
}
