//! Output files that appear together, at the end, or not at all.

use std::fs::{self, File};
use std::io::{BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use serde::Serialize;
use tempfile::NamedTempFile;

/// Files that are written under temporary names.
#[derive(Debug)]
pub struct Artefacts {
    folder: PathBuf,
    files: Vec<(NamedTempFile, &'static str)>,
    left_out: Vec<&'static str>,
}

impl Artefacts {
    /// Artefacts for `folder`, which is created where there is none.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn new(folder: &Path) -> Result<Self> {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        Ok(Self {
            folder: folder.to_owned(),
            files: Vec::new(),
            left_out: Vec::new(),
        })
    }

    /// Begins a file.
    ///
    /// # Errors
    /// A folder has its name, or the file cannot be created.
    pub fn create(&mut self, name: &'static str) -> Result<BufWriter<File>> {
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

    /// Writes a file.
    ///
    /// # Errors
    /// As [`Self::create`], or the file cannot be written.
    pub fn write(&mut self, name: &'static str, content: impl AsRef<[u8]>) -> Result<()> {
        let mut file = self.create(name)?;
        file.write_all(content.as_ref())
            .and_then(|()| file.flush())
            .with_context(|| self.folder.join(name).display().to_string())
    }

    /// Writes a report as JSON.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn write_json(&mut self, name: &'static str, report: &impl Serialize) -> Result<()> {
        write_json(self.create(name)?, report)
            .with_context(|| self.folder.join(name).display().to_string())
    }

    /// Begins a file that a run may do without; where it does, one of a run before is removed, so
    /// that what is there belongs together.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn create_if(
        &mut self,
        is_wanted: bool,
        name: &'static str,
    ) -> Result<Option<BufWriter<File>>> {
        if is_wanted {
            return self.create(name).map(Some);
        }
        self.left_out.push(name);
        Ok(None)
    }

    /// Opens a file that has been written, from its beginning.
    ///
    /// # Errors
    /// It has not been written, or cannot be read.
    pub fn reopen(&self, name: &str) -> Result<BufReader<File>> {
        let (file, _) = self
            .files
            .iter()
            .find(|(_, written)| *written == name)
            .with_context(|| format!("{name} has not been written"))?;
        Ok(BufReader::new(file.reopen()?))
    }

    /// Gives all files their names, and returns these as a list.
    ///
    /// # Errors
    /// A file cannot be renamed.
    pub fn keep(self) -> Result<String> {
        let names: Vec<_> = self.files.iter().map(|(_, name)| *name).collect();
        for (file, name) in self.files {
            let place = self.folder.join(name);
            let file = file.persist(&place).map_err(|failed| failed.error);
            let kept = file.with_context(|| place.display().to_string())?;
            share(&kept)?;
        }
        for name in self.left_out {
            let place = self.folder.join(name);
            if place.is_file() {
                fs::remove_file(&place).with_context(|| place.display().to_string())?;
            }
        }
        Ok(names.join(", "))
    }
}

/// JSON for people too.
fn write_json(mut out: impl Write, report: &impl Serialize) -> Result<()> {
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
