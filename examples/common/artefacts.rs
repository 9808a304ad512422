//! Output files that appear together, at the end, or not at all.

use std::fs::{self, File};
use std::io::{BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use serde::Serialize;
use tempfile::NamedTempFile;

/// Files that are written under temporary names.
pub(crate) struct Artefacts {
    folder: PathBuf,
    files: Vec<(NamedTempFile, &'static str)>,
}

impl Artefacts {
    /// Artefacts for `folder`, which is created where there is none.
    pub(crate) fn new(folder: &Path) -> Result<Self> {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        Ok(Self {
            folder: folder.to_owned(),
            files: Vec::new(),
        })
    }

    pub(crate) fn create(&mut self, name: &'static str) -> Result<BufWriter<File>> {
        let path = self.folder.join(name);
        let place = || path.display().to_string();
        // What cannot be replaced at the end is refused now, with no file in place yet.
        ensure!(!path.is_dir(), "{}: is a folder", place());
        let file = tempfile::Builder::new()
            .prefix(name)
            .tempfile_in(&self.folder)
            .with_context(place)?;
        let handle = file.reopen().with_context(place)?;
        self.files.push((file, name));
        Ok(BufWriter::new(handle))
    }

    /// Opens a file that has been written, from its beginning.
    pub(crate) fn reopen(&self, name: &str) -> Result<BufReader<File>> {
        let (file, _) = self
            .files
            .iter()
            .find(|(_, written)| *written == name)
            .with_context(|| format!("{name} has not been written"))?;
        Ok(BufReader::new(file.reopen()?))
    }

    /// Gives all files their names.
    pub(crate) fn keep(self) -> Result<()> {
        for (file, name) in self.files {
            let place = self.folder.join(name);
            let file = file.persist(&place).map_err(|failed| failed.error);
            let kept = file.with_context(|| place.display().to_string())?;
            share(&kept)?;
        }
        Ok(())
    }
}

/// Writes a report, for people too.
pub(crate) fn write_json(mut out: impl Write, report: &impl Serialize) -> Result<()> {
    serde_json::to_writer_pretty(&mut out, report)?;
    writeln!(out)?;
    Ok(out.flush()?)
}

/// Temporary files are private; what is kept is as readable as any new file.
#[cfg(unix)]
fn share(file: &File) -> Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    Ok(file.set_permissions(fs::Permissions::from_mode(0o644))?)
}

#[cfg(not(unix))]
fn share(_: &File) -> Result<()> {
    Ok(())
}
