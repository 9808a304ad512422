//! An open port as a stream of tokio.

use alloc::collections::VecDeque;
use core::{
    fmt,
    pin::Pin,
    task::{Context, Poll, ready},
    time::Duration,
};
use std::io;

use tokio::{
    io::{AsyncRead, AsyncWrite, ReadBuf},
    net::TcpListener,
    time::{Instant, Interval, Sleep, interval_at, sleep_until},
};

use super::{echo::Echo, heard::Heard, tcp::set_options, telnet::Telnet};
#[cfg(unix)]
use super::{marks::Marks, pty::OtherEnd};

/// Characters that are read or written at a time.
const PIECE: usize = 256;

/// From one sign of life of TELNET to the next.
const SILENCE: Duration = Duration::from_secs(10);

/// An open port.
///
/// Damaged characters and BREAK, where a port tells them, come as errors that are a
/// [`Damage`](proto3964r::tokio::Damage), in their place among the characters; stations of
/// `proto3964r::tokio` understand them.
pub struct Port {
    stream: Pin<Box<dyn Stream>>,
    coding: Coding,
    echo: Option<Echo>,
    /// When an echo is overdue.
    overdue: Option<Pin<Box<Sleep>>>,
    heard: VecDeque<Heard>,
    /// What the stream has not taken.
    output: VecDeque<u8>,
    /// Where whoever connects next takes the place of the partner.
    listener: Option<TcpListener>,
    /// When TELNET says something that means nothing, so that a server that is gone is noticed.
    say_nothing: Option<Interval>,
    #[cfg(unix)]
    _other_end: Option<OtherEnd>,
}

pub(super) trait Stream: AsyncRead + AsyncWrite + Send {}

impl<S: AsyncRead + AsyncWrite + Send> Stream for S {}

/// How characters are carried.
#[derive(Debug)]
pub(super) enum Coding {
    Plain,
    #[cfg(unix)]
    Marked(Marks),
    Telnet(Telnet),
}

impl Port {
    pub(super) fn new(stream: impl Stream + 'static, coding: Coding, echo: Option<Echo>) -> Self {
        let is_telnet = matches!(coding, Coding::Telnet(_));
        Self {
            stream: Box::pin(stream),
            coding,
            listener: None,
            say_nothing: is_telnet.then(|| interval_at(Instant::now() + SILENCE, SILENCE)),
            echo,
            overdue: None,
            heard: VecDeque::new(),
            output: VecDeque::new(),
            #[cfg(unix)]
            _other_end: None,
        }
    }

    /// Goes on listening for partners.
    pub(super) fn with_listener(self, listener: TcpListener) -> Self {
        Self {
            listener: Some(listener),
            ..self
        }
    }

    /// Takes the last of those who have connected meanwhile.
    fn poll_accept(&mut self, context: &mut Context<'_>) -> io::Result<()> {
        while let Some(listener) = &self.listener
            && let Poll::Ready(accepted) = listener.poll_accept(context)
        {
            let (stream, _) = accepted?;
            set_options(&stream)?;
            self.stream = Box::pin(stream);
            self.heard.clear();
            self.output.clear();
            if let Some(echo) = &mut self.echo {
                echo.forget();
            }
        }
        Ok(())
    }

    /// Keeps the other end as long as the port.
    #[cfg(unix)]
    pub(super) fn with_other_end(self, other_end: OtherEnd) -> Self {
        Self {
            _other_end: Some(other_end),
            ..self
        }
    }

    pub(super) const fn telnet(&self) -> Option<&Telnet> {
        match &self.coding {
            Coding::Telnet(telnet) => Some(telnet),
            _ => None,
        }
    }

    /// Writes what TELNET has to say, and reads once; whether the connection is still open.
    pub(super) fn poll_exchange(&mut self, context: &mut Context<'_>) -> Poll<io::Result<bool>> {
        let mut bytes = [0; PIECE];
        let mut piece = ReadBuf::new(&mut bytes);
        self.poll_accept(context)?;
        while let Some(interval) = &mut self.say_nothing
            && interval.poll_tick(context).is_ready()
        {
            self.output.extend(Telnet::NOTHING);
        }
        // Whatever cannot be written now is written with the next poll.
        if let Poll::Ready(Err(error)) = self.poll_drain(context) {
            return Poll::Ready(Err(error));
        }
        let read = self.stream.as_mut().poll_read(context, &mut piece);
        if read.is_pending() {
            self.forget_echo(context);
        }
        ready!(read)?;
        for &byte in piece.filled() {
            let heard = match &mut self.coding {
                Coding::Plain => Some(Ok(byte)),
                #[cfg(unix)]
                Coding::Marked(marks) => marks.take(byte),
                Coding::Telnet(telnet) => telnet.take(byte).map_err(io::Error::other)?,
            };
            let heard = match &mut self.echo {
                Some(echo) => heard.and_then(|heard| echo.hear(heard)),
                None => heard,
            };
            self.heard.extend(heard);
        }
        Poll::Ready(Ok(!piece.filled().is_empty()))
    }

    /// Where nothing is left to read: no longer awaits an echo that is overdue, and looks again
    /// when one will be.
    fn forget_echo(&mut self, context: &mut Context<'_>) {
        let Some(echo) = &mut self.echo else { return };
        echo.silence(Instant::now().into_std());
        self.overdue = echo
            .until()
            .map(|until| Box::pin(sleep_until(until.into())));
        if let Some(overdue) = &mut self.overdue
            && overdue.as_mut().poll(context).is_ready()
        {
            context.waker().wake_by_ref();
        }
    }

    /// Writes what was taken and what TELNET has to say.
    fn poll_drain(&mut self, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        if let Coding::Telnet(telnet) = &mut self.coding {
            self.output.extend(telnet.replies());
        }
        loop {
            let (piece, _) = self.output.as_slices();
            if piece.is_empty() {
                return Poll::Ready(Ok(()));
            }
            let len = ready!(self.stream.as_mut().poll_write(context, piece))?;
            if len == 0 {
                return Poll::Ready(Err(io::ErrorKind::WriteZero.into()));
            }
            self.output.drain(..len);
        }
    }

    /// Hands out characters up to the next damage, or that; whether there was any.
    fn hand_out(&mut self, buffer: &mut ReadBuf<'_>) -> io::Result<bool> {
        if let Some(&Err(damage)) = self.heard.front() {
            self.heard.pop_front();
            return Err(damage.into());
        }
        let before = buffer.filled().len();
        while buffer.remaining() > 0
            && let Some(&Ok(byte)) = self.heard.front()
        {
            self.heard.pop_front();
            buffer.put_slice(&[byte]);
        }
        Ok(buffer.filled().len() > before)
    }
}

impl AsyncRead for Port {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        while !self.hand_out(buffer)? {
            let is_open = ready!(self.poll_exchange(context))?;
            if !is_open {
                break;
            }
        }
        Poll::Ready(Ok(()))
    }
}

impl AsyncWrite for Port {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        ready!(self.poll_drain(context))?;
        let piece = bytes.get(..PIECE).unwrap_or(bytes);
        let is_telnet = self.telnet().is_some();
        for &byte in piece {
            if is_telnet {
                self.output.extend(Telnet::encode(byte));
            } else {
                self.output.push_back(byte);
            }
        }
        if let Some(echo) = &mut self.echo {
            echo.sent(Instant::now().into_std(), piece);
        }
        match self.poll_drain(context) {
            Poll::Ready(Err(error)) => Poll::Ready(Err(error)),
            _ => Poll::Ready(Ok(piece.len())),
        }
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        ready!(self.poll_drain(context))?;
        self.stream.as_mut().poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        ready!(self.poll_drain(context))?;
        self.stream.as_mut().poll_shutdown(context)
    }
}

impl fmt::Debug for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Port")
            .field("coding", &self.coding)
            .field("echo", &self.echo)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use tokio::{
        io::{AsyncReadExt as _, AsyncWriteExt as _, duplex},
        net::TcpStream,
        time::timeout,
    };

    use super::*;

    /// A serial server over RFC 2217 hears from an idle port every 10 s.
    #[tokio::test(start_paused = true)]
    async fn telnet_gives_signs_of_life() {
        let (here, mut there) = duplex(1024);
        let frame = "rfc2217://h:1"
            .parse::<super::super::Address>()
            .unwrap()
            .frame;
        let coding = Coding::Telnet(Telnet::new(frame));
        let mut port = Port::new(here, coding, None);
        let begin = Instant::now();
        let listening = timeout(Duration::from_secs(35), async {
            drop(port.read_u8().await);
        });
        let hearing = async {
            let (mut last, mut signs) = (0, Vec::new());
            while let Ok(byte) = there.read_u8().await {
                // IAC NOP.
                if (last, byte) == (255, 241) {
                    signs.push(begin.elapsed().as_secs());
                }
                last = byte;
                if signs.len() == 3 {
                    break;
                }
            }
            signs
        };
        let (_, signs) = tokio::join!(listening, hearing);
        assert_eq!(signs, [10, 20, 30]);
    }

    #[tokio::test]
    async fn who_connects_next_takes_the_place_of_who_is_gone() {
        let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let host = listener.local_addr().unwrap();
        drop(listener);
        let address = format!("tcp-listen://{host}?echo=remove");
        let address: super::super::Address = address.parse().unwrap();
        let opening = tokio::spawn(async move { address.open().await.unwrap() });
        let connect = async || loop {
            if let Ok(stream) = TcpStream::connect(host).await {
                return stream;
            }
        };
        let mut first = connect().await;
        let mut port = opening.await.unwrap();
        first.write_all(b"1").await.unwrap();
        assert_eq!(port.read_u8().await.unwrap(), b'1');
        // The first is still open, and says nothing, not even the echo.
        port.write_all(b"2").await.unwrap();
        let mut second = connect().await;
        second.write_all(b"2").await.unwrap();
        assert_eq!(port.read_u8().await.unwrap(), b'2');
        port.write_all(b"3").await.unwrap();
        assert_eq!(second.read_u8().await.unwrap(), b'3');
        assert_eq!(first.read_u8().await.unwrap(), b'2');
        assert_eq!(first.read(&mut [0]).await.unwrap(), 0, "closed");
    }
}
