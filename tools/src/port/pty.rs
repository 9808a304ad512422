//! New pseudo-terminals.

use std::{
    fs, io,
    os::{
        fd::OwnedFd,
        unix::{ffi::OsStrExt as _, fs::symlink},
    },
    path::{Path, PathBuf},
};

use rustix::{
    fs::{Mode, OFlags, fcntl_setfl, open},
    pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt},
    termios::{OptionalActions, tcgetattr, tcsetattr},
};

use super::tty::{Tty, stream};

/// A new pseudo-terminal, whose other end has a name of its own.
pub(super) fn create(path: &str) -> io::Result<(Tty, OtherEnd)> {
    let terminal = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
    fcntl_setfl(&terminal, OFlags::RDWR | OFlags::NONBLOCK)?;
    grantpt(&terminal)?;
    unlockpt(&terminal)?;
    let name = ptsname(&terminal, Vec::new())?;
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
    let held = open(name.as_c_str(), flags, Mode::empty())?;
    let mut settings = tcgetattr(&held)?;
    settings.make_raw();
    tcsetattr(&held, OptionalActions::Now, &settings)?;
    let target = PathBuf::from(std::ffi::OsStr::from_bytes(name.as_bytes()));
    let link = PathBuf::from(path);
    make_link(&target, &link)?;
    let other_end = OtherEnd {
        _held: held,
        link,
        target,
    };
    Ok((stream(terminal)?, other_end))
}

/// Links the path; one that a program which was killed has left is replaced.
fn make_link(target: &Path, link: &Path) -> io::Result<()> {
    let is_left_over = fs::read_link(link).is_ok_and(|old| old.starts_with("/dev/pts"));
    if is_left_over {
        fs::remove_file(link)?;
    }
    symlink(target, link)
}

/// The end that another program opens.
#[derive(Debug)]
pub(super) struct OtherEnd {
    /// While nobody has it open, reading this end would fail.
    _held: OwnedFd,
    link: PathBuf,
    target: PathBuf,
}

impl Drop for OtherEnd {
    fn drop(&mut self) {
        // Another program may have put its own in its place.
        if fs::read_link(&self.link).is_ok_and(|target| target == self.target) {
            drop(fs::remove_file(&self.link));
        }
    }
}
