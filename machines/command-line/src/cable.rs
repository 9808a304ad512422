//! A serial cable between two ports of this program, which may change what it carries.

use anyhow::Result;
use serialport::SerialPort;

/// One end of a cable, as a driver takes it.
pub type Port = Box<dyn SerialPort>;

/// Two pseudo-terminals whose far ends are joined.
#[derive(Debug)]
pub struct Cable {
    #[cfg(unix)]
    ends: [serialport::TTYPort; 2],
}

#[cfg(not(unix))]
impl Cable {
    /// There is none on this system.
    ///
    /// # Errors
    /// Always.
    pub fn open() -> Result<(Self, [Port; 2])> {
        anyhow::bail!("pseudo-terminals need a Unix system")
    }

    /// Not called: none can be opened.
    ///
    /// # Errors
    /// Always.
    pub fn carry<T>(
        self,
        _: impl FnMut(bool, &[u8]) -> Result<Vec<u8>> + Send,
        _: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        anyhow::bail!("pseudo-terminals need a Unix system")
    }
}

#[cfg(unix)]
impl Cable {
    /// A cable and the ports at its ends. A port that is closed while the cable carries is an
    /// error.
    ///
    /// # Errors
    /// The system has no pseudo-terminals left.
    pub fn open() -> Result<(Self, [Port; 2])> {
        use anyhow::Context as _;
        use serialport::TTYPort;

        let (end, port) = TTYPort::pair().context("pseudo-terminal")?;
        let (other_end, other_port) = TTYPort::pair().context("pseudo-terminal")?;
        let ends = [end, other_end];
        Ok((Self { ends }, [Box::new(port), Box::new(other_port)]))
    }

    /// Carries bytes both ways while `work` lasts: `pass` takes what the first end sends, or the
    /// second, and says what arrives at the other.
    ///
    /// # Errors
    /// Those of `pass` and of `work`, or a port cannot be read or written; then both ports hang up.
    pub fn carry<T>(
        self,
        pass: impl FnMut(bool, &[u8]) -> Result<Vec<u8>> + Send,
        work: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        use anyhow::anyhow;
        use core::sync::atomic::AtomicBool;
        use std::sync::Mutex;
        use std::thread;

        let [first, second] = self.ends;
        let (from_first, from_second) = (first.try_clone_native()?, second.try_clone_native()?);
        let (pass, closed) = (Mutex::new(pass), AtomicBool::new(false));
        let (pass, closed) = (&pass, &closed);
        let direction = |from, to, is_first| {
            let _closing = Closing(closed);
            carry(from, to, closed, |bytes| {
                let mut pass = pass.lock().map_err(|_| anyhow!("the cable panicked"))?;
                pass(is_first, bytes)
            })
        };
        thread::scope(|scope| {
            let forth = scope.spawn(|| direction(from_first, second, true));
            let back = scope.spawn(|| direction(from_second, first, false));
            let closing = Closing(closed);
            let result = work();
            drop(closing);
            for thread in [forth, back] {
                thread.join().map_err(|_| anyhow!("the cable panicked"))??;
            }
            result
        })
    }
}

/// Ends both directions, however its owner ends.
#[cfg(unix)]
struct Closing<'a>(&'a core::sync::atomic::AtomicBool);

#[cfg(unix)]
impl Drop for Closing<'_> {
    fn drop(&mut self) {
        self.0.store(true, core::sync::atomic::Ordering::Relaxed);
    }
}

/// Carries one direction until the cable is closed.
#[cfg(unix)]
fn carry(
    mut from: serialport::TTYPort,
    mut to: serialport::TTYPort,
    closed: &core::sync::atomic::AtomicBool,
    mut pass: impl FnMut(&[u8]) -> Result<Vec<u8>>,
) -> Result<()> {
    use core::sync::atomic::Ordering;
    use std::io::{ErrorKind, Read as _, Write as _};

    let mut buffer = [0; 64];
    while !closed.load(Ordering::Relaxed) {
        let count = match from.read(&mut buffer) {
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::TimedOut => continue,
            Err(error) => return Err(error.into()),
        };
        let sent = buffer.get(..count).unwrap_or_default();
        to.write_all(&pass(sent)?)?;
    }
    Ok(())
}
