//! Streams and the clock of tokio as the asynchronous driver wants them.

use alloc::boxed::Box;
use core::{fmt, pin::Pin, time::Duration};
use std::io;

use ::tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, ReadHalf, WriteHalf},
    time::Instant,
};
use embedded_io_async::{ErrorType, Read, Write};

use crate::{blocking::closed, embedded_io_async::AsyncClock};

/// A stream of any kind.
trait Stream: AsyncRead + AsyncWrite + Send {}

impl<S: AsyncRead + AsyncWrite + Send> Stream for S {}

type AnyStream = Pin<Box<dyn Stream>>;

/// The two halves of a stream.
pub(super) fn split(stream: impl AsyncRead + AsyncWrite + Send + 'static) -> (Reader, Writer) {
    let stream: AnyStream = Box::pin(stream);
    let (reader, writer) = ::tokio::io::split(stream);
    (Reader(reader), Writer(writer))
}

/// The half of a stream that is read.
pub struct Reader(ReadHalf<AnyStream>);

impl fmt::Debug for Reader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Reader")
    }
}

impl ErrorType for Reader {
    type Error = io::Error;
}

impl Read for Reader {
    async fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.0.read(buffer).await? {
            0 => Err(closed()),
            len => Ok(len),
        }
    }
}

/// The half of a stream that is written.
pub struct Writer(WriteHalf<AnyStream>);

impl fmt::Debug for Writer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Writer")
    }
}

impl ErrorType for Writer {
    type Error = io::Error;
}

impl Write for Writer {
    async fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes).await
    }

    async fn flush(&mut self) -> io::Result<()> {
        self.0.flush().await
    }
}

/// The clock of the runtime.
#[derive(Clone, Copy, Debug)]
pub struct Clock(Instant);

impl Clock {
    pub(super) fn new() -> Self {
        Self(Instant::now())
    }
}

/// Returns when it is `due`, counted from an epoch; never without a time, or at one beyond the
/// clock.
pub async fn sleep(epoch: Instant, due: Option<Duration>) {
    match due.and_then(|due| epoch.checked_add(due)) {
        Some(instant) => ::tokio::time::sleep_until(instant).await,
        None => core::future::pending().await,
    }
}

impl AsyncClock for Clock {
    fn now(&mut self) -> Duration {
        self.0.elapsed()
    }

    async fn sleep_until(&mut self, time: Duration) {
        sleep(self.0, Some(time)).await;
    }
}
