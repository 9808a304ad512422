//! Where the procedure and the job stand.

/// Where the procedure stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum State {
    Idle,
    /// STX came, the receive buffer is in use.
    WaitBuffer,
    /// DLE is sent, the block comes in; nothing is wrong with it and the next character may be data.
    Receiving,
    /// The same behind a DLE, in front of the BCC, or with an error noted.
    ReceivingOther,
    /// NAK is sent, the repeat is awaited within BWZ.
    AwaitRepeat,
    /// Silence is awaited after noise in idle.
    NoiseQuiet,
    /// STX is queued or sent, DLE is awaited.
    AwaitDle,
    /// The block goes out; a data byte is next, or the end. `limit` is when the characters that
    /// were handed out are on the line, and QVZ later the output has stalled.
    Sending,
    /// The same with something else to send first: a reply, or the rest of DLE DLE, DLE ETX BCC.
    SendingOther,
    /// Silence is awaited after something interrupted the block.
    ResendQuiet,
    /// The block is out, its answer is awaited.
    AwaitAck,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Job {
    None,
    /// Waiting or under way.
    Open,
    /// The outcome is in the notes.
    Closed,
}

impl State {
    /// Whether a block comes in.
    pub(super) const fn is_receiving(self) -> bool {
        matches!(self, Self::Receiving | Self::ReceivingOther)
    }

    /// Whether a block goes out.
    pub(super) const fn is_sending(self) -> bool {
        matches!(self, Self::Sending | Self::SendingOther)
    }

    /// Whether the station has sent or is about to send STX for its job.
    pub(super) const fn is_job(self) -> bool {
        self.is_sending() || matches!(self, Self::AwaitDle | Self::ResendQuiet | Self::AwaitAck)
    }

    /// Whether something beside `deadline` may be due.
    pub(super) const fn has_other_due(self) -> bool {
        self.is_sending()
            || matches!(
                self,
                Self::WaitBuffer | Self::ReceivingOther | Self::NoiseQuiet | Self::ResendQuiet
            )
    }
}
