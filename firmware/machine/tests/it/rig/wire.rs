//! One direction of a serial line.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::future::poll_fn;
use std::rc::Rc;
use std::task::Poll;

use embedded_io_async::{ErrorType, Read, Write};

#[derive(Clone, Default)]
pub struct Wire(Rc<RefCell<VecDeque<u8>>>);

impl Wire {
    pub fn push(&self, byte: u8) {
        self.0.borrow_mut().push_back(byte);
    }

    pub fn pop(&self) -> Option<u8> {
        self.0.borrow_mut().pop_front()
    }
}

impl ErrorType for Wire {
    type Error = Infallible;
}

impl Read for Wire {
    async fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Infallible> {
        // Whoever waits is looked at again without being woken.
        poll_fn(|_| {
            let mut bytes = buffer.iter_mut().zip(std::iter::from_fn(|| self.pop()));
            match bytes.by_ref().map(|(place, byte)| *place = byte).count() {
                0 => Poll::Pending,
                len => Poll::Ready(Ok(len)),
            }
        })
        .await
    }
}

impl Write for Wire {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        bytes.iter().for_each(|&byte| self.push(byte));
        Ok(bytes.len())
    }

    async fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
