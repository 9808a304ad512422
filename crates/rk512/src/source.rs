//! What the server asks for data.

use crate::command::Command;
use crate::reaction::ReactionError;

/// The memory that a [`Server`](crate::Server) reads and writes: the caller's, or a ready
/// [`Memory`](crate::Memory).
///
/// For each command the server calls [`size`](Self::size), then [`open`](Self::open); after an
/// `open` that succeeded, [`read`](Self::read) or [`write`](Self::write) once for each telegram,
/// then exactly one of [`close`](Self::close) and [`abort`](Self::abort). The reaction goes out
/// when the call has returned: a SEND that `write` and `close` accepted is a SEND that the partner
/// may rely on. A source that needs time until that is true [`holds`](Self::holds) the job.
///
/// Every error becomes the reaction's error number and ends the job.
pub trait DataSource {
    /// Units (words or bytes, as the area counts) in the block or area that `command` addresses,
    /// counted from unit 0. The server itself checks that the job lies within them.
    ///
    /// # Errors
    /// [`ReactionError::NoSuchBlock`] for a missing DB or DX, [`ReactionError::RequestType`] for
    /// an area that is not served.
    fn size(&mut self, command: &Command) -> Result<usize, ReactionError>;

    /// A job begins.
    ///
    /// # Errors
    /// [`ReactionError::Locked`] if the command's coordination flag is set,
    /// [`ReactionError::Stopped`], [`ReactionError::AccessDenied`].
    fn open(&mut self, command: &Command) -> Result<(), ReactionError> {
        let _ = command;
        Ok(())
    }

    /// Fills `data` with what stands `offset` bytes after the start of the job.
    ///
    /// # Errors
    /// Any; the job ends.
    fn read(
        &mut self,
        command: &Command,
        offset: usize,
        data: &mut [u8],
    ) -> Result<(), ReactionError>;

    /// Stores `data` at `offset` bytes after the start of the job.
    ///
    /// A job of more than 128 bytes comes in several calls: a source that must not show half of it
    /// holds them until [`close`](Self::close).
    ///
    /// # Errors
    /// Any; the job ends.
    fn write(&mut self, command: &Command, offset: usize, data: &[u8])
    -> Result<(), ReactionError>;

    /// Whether the last reaction of the job waits for [`Server::confirm`](crate::Server::confirm),
    /// before which `close` is not called.
    fn holds(&self, command: &Command) -> bool {
        let _ = command;
        false
    }

    /// All data of the job have moved; here the coordination flag is set.
    ///
    /// # Errors
    /// Any; it becomes the last reaction.
    fn close(&mut self, command: &Command) -> Result<(), ReactionError> {
        let _ = command;
        Ok(())
    }

    /// The job ended before all data had moved.
    fn abort(&mut self, command: &Command) {
        let _ = command;
    }
}
