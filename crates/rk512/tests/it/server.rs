//! The server: whole jobs, and every check that needs history or the data source.

use core::time::Duration;

use rk512::{
    AbandonCause, Area, Command, CommandError, Config, Continuation, Coordination,
    CoordinationFlag, Cpu, DataBlock, DataSource, MAX_DATA, Memory, Reaction, ReactionError,
    Server, ServerEvent, Telegram,
};

const NOW: Duration = Duration::from_millis(5);

/// A server whose reactions are delivered at once.
struct Bench<'a> {
    server: Server,
    plc: Memory<'a, 2>,
}

impl<'a> Bench<'a> {
    fn new(db5: &'a mut [u8], dx3: &'a mut [u8], flags: &'a mut [u8]) -> Self {
        let blocks = [DataBlock::db(5, db5), DataBlock::dx(3, dx3)];
        Self {
            server: Server::new(Config::DEFAULT),
            plc: Memory {
                flags,
                ..Memory::new(blocks)
            },
        }
    }

    /// The reaction to `block`.
    fn ask(&mut self, block: &[u8]) -> Vec<u8> {
        self.server.handle_block(block, &mut self.plc);
        let reaction = self.server.poll_transmit().expect("a reaction");
        self.server.handle_delivered(NOW);
        reaction.to_vec()
    }

    /// The reaction's error number and the event behind it.
    fn refusal(&mut self, block: &[u8]) -> (u8, CommandError) {
        let reaction = self.ask(block);
        assert_eq!((reaction.len(), &reaction[1..3]), (4, &[0, 0][..]));
        match self.server.poll_event() {
            Some(ServerEvent::Refused(error)) => (reaction[3], error),
            other => panic!("{other:?} instead of a refusal"),
        }
    }
}

fn pattern(len: usize) -> Vec<u8> {
    (0..=u8::MAX).cycle().take(len).collect()
}

fn send(area: Area, words: u16, data: &[u8]) -> Telegram {
    let command = Command::send(area, words).unwrap();
    command.telegram(&data[..data.len().min(MAX_DATA)]).unwrap()
}

fn fetch(area: Area, length: u16) -> Telegram {
    let command = Command::fetch(area, length).unwrap();
    command.telegram(&[]).unwrap()
}

fn go_on(area: Area, data: &[u8]) -> Telegram {
    let request = Command::send(area, 1).unwrap().request();
    Continuation::new(request).telegram(data).unwrap()
}

#[test]
fn send_of_65_words_takes_two_telegrams() {
    let (mut db5, data) = ([0; 200], pattern(130));
    let mut bench = Bench::new(&mut db5, &mut [], &mut []);
    let area = Area::db(5, 10);
    assert_eq!(bench.ask(&send(area, 65, &data)), [0, 0, 0, 0]);
    assert!(bench.server.is_busy());
    assert_eq!(bench.ask(&go_on(area, &data[128..])), [0xFF, 0, 0, 0]);
    assert!(!bench.server.is_busy());
    let command = Command::send(area, 65).unwrap();
    let event = bench.server.poll_event();
    assert_eq!(event, Some(ServerEvent::Served(command)));
    assert_eq!(db5[20..150], data);
}

#[test]
fn fetch_of_65_words_takes_two_telegrams() {
    let mut dx3: [u8; 140] = core::array::from_fn(|i| u8::try_from(i).unwrap());
    let expected = dx3;
    let mut bench = Bench::new(&mut [], &mut dx3, &mut []);
    let first = bench.ask(&fetch(Area::dx(3, 5), 65));
    assert_eq!(first[..4], [0, 0, 0, 0]);
    assert_eq!(first[4..], expected[10..138]);
    let rest = bench.ask(&[0xFF, 0, 0x45, 0x58]);
    assert_eq!(rest, [0xFF, 0, 0, 0, 138, 139]);
}

#[test]
fn e0603_e0605_continuation_of_another_request() {
    let (mut db5, data) = ([0; 200], pattern(130));
    let mut bench = Bench::new(&mut db5, &mut [], &mut []);
    bench.ask(&send(Area::db(5, 0), 65, &data));
    let (code, error) = bench.refusal(&[0xFF, 0, 0x4F, 0x44, 1, 2]);
    assert_eq!((code, error.event()), (0x16, Some(0x0603)));
    assert!(!bench.server.is_busy(), "the job has ended");
    bench.ask(&fetch(Area::db(5, 0), 65));
    let (code, error) = bench.refusal(&[0xFF, 0, 0x45, 0x4D]);
    assert_eq!((code, error.event()), (0x10, Some(0x0605)));
}

#[test]
fn e0606_e0607_e0608_the_area_is_not_there_or_too_short() {
    let mut db5 = [0; 20];
    let mut bench = Bench::new(&mut db5, &mut [], &mut []);
    let (code, error) = bench.refusal(&fetch(Area::db(6, 0), 1));
    assert_eq!((code, error.event()), (0x14, Some(0x0606)));
    let (code, error) = bench.refusal(&fetch(Area::db(5, 10), 1));
    let start = CommandError::Start {
        start: 10,
        size: 10,
    };
    assert_eq!((code, error), (0x14, start));
    assert_eq!(error.event(), Some(0x0607));
    let (code, error) = bench.refusal(&fetch(Area::db(5, 9), 2));
    let end = CommandError::End { end: 11, size: 10 };
    assert_eq!((code, error), (0x14, end));
    assert_eq!(error.event(), Some(0x0608));
    let (code, error) = bench.refusal(&fetch(Area::timers(0), 1));
    assert_eq!((code, error.event()), (0x12, None));
}

#[test]
fn e060b_continuation_too_long_or_too_short() {
    for rest in [1, 3, 128] {
        let (mut db5, data) = ([0; 200], pattern(130));
        let mut bench = Bench::new(&mut db5, &mut [], &mut []);
        bench.ask(&send(Area::db(5, 0), 65, &data));
        let (code, error) = bench.refusal(&go_on(Area::db(5, 0), &data[..rest]));
        assert_eq!((code, error.event()), (0x34, Some(0x060B)), "{rest}");
    }
}

#[test]
fn e060e_continuation_of_nothing() {
    let mut bench = Bench::new(&mut [], &mut [], &mut []);
    let block = [0xFF, 0, 0x41, 0x44, 1, 2];
    assert_eq!(bench.ask(&block), [0xFF, 0, 0, 0x36]);
    let (code, error) = bench.refusal(&block);
    assert_eq!((code, error.event()), (0x36, Some(0x060E)));
}

#[test]
fn e060e_command_before_the_reaction_replaces_it() {
    let mut db5 = [0; 4];
    let mut plc = Memory::new([DataBlock::db(5, &mut db5)]);
    let mut server = Server::new(Config::DEFAULT);
    let block = send(Area::db(5, 0), 1, &[1, 2]);
    server.handle_block(&block, &mut plc);
    server.handle_block(&block, &mut plc);
    let reaction = server.poll_transmit().unwrap();
    assert_eq!(*reaction, [0, 0, 0, 0x36]);
    assert!(!server.wants_recall());
    // One in the hands of the transport should be taken back; the error follows it.
    server.handle_block(&block, &mut plc);
    assert!(server.wants_recall() && server.poll_transmit().is_none());
    server.handle_failed(&mut plc);
    assert_eq!(*server.poll_transmit().unwrap(), [0, 0, 0, 0x36]);
    server.handle_delivered(NOW);
    assert!(server.poll_transmit().is_none());
}

#[test]
fn e060f_coordination_flag_locks_and_is_set() {
    let (mut db5, mut flags) = ([0; 4], [0; 30]);
    let mut bench = Bench::new(&mut db5, &mut [], &mut flags);
    let flag = CoordinationFlag::new(20, 3).unwrap();
    let coordination = Coordination {
        flag: Some(flag),
        cpu: Some(Cpu::One),
    };
    let command = Command::send(Area::db(5, 0), 1).unwrap();
    let command = command.with_coordination(coordination);
    let block = command.telegram(&[1, 2]).unwrap();
    assert_eq!(bench.ask(&block), [0, 0, 0, 0]);
    let (code, error) = bench.refusal(&block);
    assert_eq!((code, error.event()), (0x32, Some(0x060F)));
    assert_eq!(flags[20], 0b1000);

    let outside = CoordinationFlag::new(30, 0).unwrap();
    let command = command.with_coordination(outside.into());
    let mut bench = Bench::new(&mut db5, &mut [], &mut flags);
    let (code, _) = bench.refusal(&command.telegram(&[1, 2]).unwrap());
    assert_eq!(code, 0x0A);
}

#[test]
fn a_first_telegram_in_the_middle_of_a_job_begins_anew() {
    let (mut db5, data) = ([0; 200], pattern(130));
    let mut bench = Bench::new(&mut db5, &mut [], &mut []);
    let block = send(Area::db(5, 0), 65, &data);
    for _ in 0..2 {
        assert_eq!(bench.ask(&block), [0, 0, 0, 0]);
    }
    assert_eq!(bench.ask(&go_on(Area::db(5, 0), &[7, 8])), [0xFF, 0, 0, 0]);
    assert_eq!(db5[128..130], [7, 8]);
}

#[test]
fn a_job_without_continuation_ends_in_time() {
    let (mut db5, data) = ([0; 200], pattern(130));
    let mut bench = Bench::new(&mut db5, &mut [], &mut []);
    bench.ask(&send(Area::db(5, 0), 65, &data));
    let deadline = NOW + Duration::from_secs(20);
    assert_eq!(bench.server.poll_timeout(), Some(deadline));
    let early = deadline - Duration::from_nanos(1);
    bench.server.handle_timeout(early, &mut bench.plc);
    assert!(bench.server.is_busy());
    bench.server.handle_timeout(deadline, &mut bench.plc);
    let command = Command::send(Area::db(5, 0), 65).unwrap();
    let event = ServerEvent::Abandoned(command, AbandonCause::NoContinuation);
    assert_eq!(bench.server.poll_event(), Some(event));
    let (code, _) = bench.refusal(&go_on(Area::db(5, 0), &[7, 8]));
    assert_eq!(code, 0x36);
}

/// Counts what the server calls; refuses at one place.
#[derive(Default)]
struct Counting {
    refuse_read: bool,
    refuse_close: bool,
    opened: u32,
    closed: u32,
    aborted: u32,
}

impl DataSource for Counting {
    fn size(&mut self, _: &Command) -> Result<usize, ReactionError> {
        Ok(1000)
    }

    fn open(&mut self, _: &Command) -> Result<(), ReactionError> {
        self.opened += 1;
        Ok(())
    }

    fn read(&mut self, _: &Command, offset: usize, _: &mut [u8]) -> Result<(), ReactionError> {
        if self.refuse_read && offset > 0 {
            return Err(ReactionError::Stopped);
        }
        Ok(())
    }

    fn write(&mut self, _: &Command, _: usize, _: &[u8]) -> Result<(), ReactionError> {
        Ok(())
    }

    fn close(&mut self, _: &Command) -> Result<(), ReactionError> {
        self.closed += 1;
        if self.refuse_close {
            return Err(ReactionError::AccessDenied);
        }
        Ok(())
    }

    fn abort(&mut self, _: &Command) {
        self.aborted += 1;
    }
}

fn error_number(server: &mut Server) -> u8 {
    let telegram = server.poll_transmit().unwrap();
    server.handle_delivered(NOW);
    let (reaction, _) = Reaction::decode(&telegram).unwrap();
    reaction.result.map_or_else(ReactionError::code, |()| 0)
}

#[test]
fn each_open_has_one_close_or_abort() {
    let mut source = Counting {
        refuse_read: true,
        ..Counting::default()
    };
    let mut server = Server::new(Config::DEFAULT);
    server.handle_block(&fetch(Area::db(1, 0), 65), &mut source);
    assert_eq!(error_number(&mut server), 0);
    server.handle_block(&[0xFF, 0, 0x45, 0x44], &mut source);
    assert_eq!(error_number(&mut server), 0x2A);
    let counts = (source.opened, source.closed, source.aborted);
    assert_eq!(counts, (1, 0, 1));

    let mut source = Counting {
        refuse_close: true,
        ..Counting::default()
    };
    server.handle_block(&send(Area::db(1, 0), 1, &[1, 2]), &mut source);
    assert_eq!(error_number(&mut server), 0x0A);
    let counts = (source.opened, source.closed, source.aborted);
    assert_eq!(counts, (1, 1, 0));
}

#[test]
fn a_reaction_that_is_not_delivered_ends_the_job() {
    let mut source = Counting::default();
    let mut server = Server::new(Config::DEFAULT);
    server.handle_block(&fetch(Area::db(1, 0), 65), &mut source);
    assert!(server.poll_transmit().is_some());
    server.handle_failed(&mut source);
    let event = server.poll_event();
    let command = Command::fetch(Area::db(1, 0), 65).unwrap();
    let cause = AbandonCause::Transport;
    assert_eq!(event, Some(ServerEvent::Abandoned(command, cause)));
    assert_eq!(source.aborted, 1);
}

/// Memory whose jobs wait for their user.
struct Holding<'a>(Memory<'a, 2>);

impl DataSource for Holding<'_> {
    fn size(&mut self, command: &Command) -> Result<usize, ReactionError> {
        self.0.size(command)
    }

    fn open(&mut self, command: &Command) -> Result<(), ReactionError> {
        self.0.open(command)
    }

    fn read(&mut self, command: &Command, at: usize, data: &mut [u8]) -> Result<(), ReactionError> {
        self.0.read(command, at, data)
    }

    fn write(&mut self, command: &Command, at: usize, data: &[u8]) -> Result<(), ReactionError> {
        self.0.write(command, at, data)
    }

    fn holds(&self, _: &Command) -> bool {
        true
    }

    fn close(&mut self, command: &Command) -> Result<(), ReactionError> {
        self.0.close(command)
    }
}

#[test]
fn the_last_reaction_of_a_job_that_is_held_waits_for_its_user() {
    let (mut db5, mut dx3, mut flags) = ([0; 200], [0; 2], [0; 32]);
    let blocks = [DataBlock::db(5, &mut db5), DataBlock::dx(3, &mut dx3)];
    let flags = &mut flags;
    let mut plc = Holding(Memory {
        flags,
        ..Memory::new(blocks)
    });
    let mut server = Server::new(Config::DEFAULT);
    let deliver = |server: &mut Server| {
        let reaction = server.poll_transmit().map(|reaction| reaction.to_vec());
        server.handle_delivered(NOW);
        reaction
    };
    let flag = CoordinationFlag::new(7, 2).unwrap();
    let command = Command::send(Area::db(5, 0), 65).unwrap();
    let command = command.with_coordination(flag.into());
    let data = pattern(130);
    let first = command.telegram(&data[..MAX_DATA]).unwrap();
    let rest = Continuation::new(command.request());
    let rest = rest.telegram(&data[MAX_DATA..]).unwrap();
    for error in [Some(ReactionError::Stopped), None] {
        server.handle_block(&first, &mut plc);
        assert_eq!(deliver(&mut server).unwrap(), [0, 0, 0, 0]);
        server.handle_block(&rest, &mut plc);
        assert_eq!(server.poll_event(), Some(ServerEvent::Held(command)));
        assert_eq!((deliver(&mut server), plc.0.flags[7]), (None, 0));
        // Only after that is the flag set.
        assert!(server.confirm(error.map_or(Ok(()), Err), &mut plc));
        let code = error.map_or(0, ReactionError::code);
        assert_eq!(deliver(&mut server).unwrap(), [0xFF, 0, 0, code]);
        assert!(!server.confirm(Ok(()), &mut plc), "once");
    }
    assert_eq!(server.poll_event(), Some(ServerEvent::Served(command)));
    assert_eq!(plc.0.flags[7], flag.mask());

    let words = fetch(Area::db(5, 0), 1);
    server.handle_block(&words, &mut plc);
    assert_eq!(deliver(&mut server), None);
    // A partner that does not wait has lost the count of what it asked.
    server.handle_block(&words, &mut plc);
    assert_eq!(deliver(&mut server).unwrap(), [0, 0, 0, 0x36]);
    assert!(!server.confirm(Ok(()), &mut plc), "too late");
    server.handle_block(&words, &mut plc);
    assert!(server.confirm(Ok(()), &mut plc));
    assert_eq!(deliver(&mut server).unwrap(), [0, 0, 0, 0, 0, 1]);
}
