//! Terminals of Unix: serial ports, both ends of pseudo-terminals.

use std::{fs::File, io, os::fd::OwnedFd};

use rustix::{
    fs::{Mode, OFlags, open},
    termios::{
        ControlModes, InputModes, OptionalActions, SpecialCodeIndex, Termios, ioctl_tiocexcl,
        tcgetattr, tcsetattr,
    },
};
use tokio::{
    io::{Join, join},
    net::unix::pipe::{Receiver, Sender},
};

use super::{Frame, Parity};

/// A terminal that is read and written without blocking.
pub(super) type Tty = Join<Receiver, Sender>;

/// Opens a serial port for this program alone, with the marks of
/// [`Marks`](super::marks::Marks).
pub(super) fn open_serial(path: &str, frame: Frame) -> io::Result<Tty> {
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let terminal = open(path, flags, Mode::empty())?;
    let mut settings = tcgetattr(&terminal)?;
    ioctl_tiocexcl(&terminal)?;
    settings.make_raw();
    set_frame(&mut settings, frame)?;
    mark_damage(&mut settings, frame.parity);
    // A read returns with the first character.
    settings.special_codes[SpecialCodeIndex::VMIN] = 1;
    settings.special_codes[SpecialCodeIndex::VTIME] = 0;
    tcsetattr(&terminal, OptionalActions::Now, &settings)?;
    check_speed(&tcgetattr(&terminal)?, frame.baud)?;
    stream(terminal)
}

/// A terminal that is set up, and does not block. The streams are those of pipes, which read and
/// write as terminals do.
pub(super) fn stream(terminal: OwnedFd) -> io::Result<Tty> {
    let reader = File::from(terminal);
    let writer = Sender::from_file_unchecked(reader.try_clone()?)?;
    Ok(join(Receiver::from_file_unchecked(reader)?, writer))
}

fn set_frame(settings: &mut Termios, frame: Frame) -> io::Result<()> {
    let modes = &mut settings.control_modes;
    modes.remove(ControlModes::CSIZE | ControlModes::CRTSCTS);
    modes.insert(ControlModes::CS8 | ControlModes::CREAD | ControlModes::CLOCAL);
    modes.set(ControlModes::CSTOPB, frame.stop_bits == 2);
    modes.set(ControlModes::PARENB, frame.parity != Parity::None);
    modes.set(ControlModes::PARODD, frame.parity == Parity::Odd);
    settings.set_speed(frame.baud)?;
    Ok(())
}

/// Damaged characters and BREAK are handed on, with marks before them.
fn mark_damage(settings: &mut Termios, parity: Parity) {
    let modes = &mut settings.input_modes;
    modes.remove(InputModes::IGNBRK | InputModes::BRKINT | InputModes::IGNPAR);
    modes.insert(InputModes::PARMRK);
    modes.set(InputModes::INPCK, parity != Parity::None);
}

/// A driver sets the next rate that it can.
fn check_speed(settings: &Termios, baud: u32) -> io::Result<()> {
    let set = settings.output_speed();
    // As much as a UART bears: a character of 11 bits, sampled in its middle.
    let is_near = u64::from(set.abs_diff(baud)) * 50 <= u64::from(baud);
    if is_near {
        return Ok(());
    }
    Err(io::Error::new(
        io::ErrorKind::InvalidInput,
        format!("the port is set to {set} bit/s in place of {baud}"),
    ))
}
