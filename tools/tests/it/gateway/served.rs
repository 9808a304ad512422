//! RK512 both ways: areas that the gateway serves, to a partner that sends and fetches.

use alloc::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};
use core::{
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use rk512::{
    Area, CallError, Command, CoordinationFlag, DataBlock, JobError, Memory, ReactionError,
    tokio::Client,
};
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::{net::TcpListener, time::sleep};

use super::{
    broker_or_skip,
    listeners::listen,
    partner::{PARTNER, Partner},
    process::{Gateway, hall, line, mqtt},
    subscriber::Subscriber,
};

const AREAS: &str = "procedure = \"rk512\"
[[line.area]]
name = \"oven\"
start = \"DB 10.0\"
length = 1
poll_s = 0.2
[[line.area]]
name = \"orders\"
start = \"DB 20.4\"
length = 70
served = true
field = [{ name = \"last\", offset = 138, type = \"u16be\" }]
[[line.area]]
name = \"setpoints\"
start = \"DX 3.0\"
length = 2
served = true
writable = true
field = [{ name = \"speed\", offset = 2, type = \"i16be\", scale = 0.1 }]
[[line.area]]
name = \"marks\"
start = \"flags 10\"
length = 2
served = true
writable = true
field = [{ name = \"order\", offset = 0, type = \"bit\", bit = 3 }]
";

fn refusal<T>(result: Result<T, CallError>) -> ReactionError {
    match result {
        Err(CallError::Failed(JobError::Refused(error))) => error,
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("not refused"),
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_partner_sends_to_the_gateway_and_fetches_from_it() {
    let broker = broker_or_skip!();
    let partner = Partner::new().await;
    let config = hall(&[&mqtt(broker.port), &line("plc", partner.port), AREAS]);
    let mut subscriber = Subscriber::new(broker.port).await;
    let _gateway = Gateway::start(&config);
    let db10 = Box::leak(vec![0, 7].into_boxed_slice());
    let plc = Client::with_source(
        partner.stream().await,
        PARTNER,
        rk512::Config::DEFAULT,
        Memory::new([DataBlock::db(10, db10)]),
        |_| {},
    );
    let area = |name| format!("line3964r/hall/plc/area/{name}");
    // The gateway asks too, all the time.
    assert_eq!(subscriber.json_at(&area("oven")).await["hex"], "00 07");

    // In two telegrams.
    let mut order: Vec<u8> = (0..140).collect();
    plc.send(Area::db(20, 4), &order).await.unwrap();
    let told = subscriber.json_at(&area("orders")).await;
    assert_eq!(told["fields"]["last"]["value"], 138 * 256 + 139);
    plc.send(Area::db(20, 73), &[1, 2]).await.unwrap();
    let told = subscriber.json_at(&area("orders")).await;
    assert_eq!(told["fields"]["last"]["value"], 0x0102);
    order[138..].copy_from_slice(&[1, 2]);
    assert_eq!(plc.fetch(Area::db(20, 4), 70).await.unwrap(), order);

    let command = |text: &'static str| subscriber.command("plc", text);
    assert_eq!(plc.fetch(Area::dx(3, 0), 2).await.unwrap(), [0; 4]);
    command(r#"{"write": "setpoints", "fields": {"speed": -12.5}}"#).await;
    command(r#"{"write": "orders", "hex": "00"}"#).await;
    let told = subscriber.json_at(&area("setpoints")).await;
    assert_eq!(told["fields"]["speed"]["value"], -12.5);
    let outcome = subscriber.outcome("plc").await;
    assert_eq!(outcome["ok"], true, "{outcome}");
    let outcome = subscriber.outcome("plc").await;
    assert_eq!(outcome["error"], "`orders` is not writable");
    assert_eq!(
        plc.fetch(Area::dx(3, 1), 1).await.unwrap(),
        (-125_i16).to_be_bytes()
    );

    // A coordination flag: set with the data, and locked until it is cleared.
    let flag = CoordinationFlag::new(10, 3).unwrap();
    let send = Command::send(Area::db(20, 4), 1).unwrap();
    let send = send.with_coordination(flag.into());
    plc.run(send, &[9, 9]).await.unwrap();
    let told = subscriber.json_at(&area("orders")).await;
    assert!(told["hex"].as_str().unwrap().starts_with("09 09 02"));
    assert_eq!(subscriber.json_at(&area("marks")).await["hex"], "08 00");
    assert_eq!(refusal(plc.run(send, &[8, 8]).await), ReactionError::Locked);
    let fetch = Command::fetch(Area::db(20, 4), 1).unwrap();
    let fetch = fetch.with_coordination(flag.into());
    assert_eq!(refusal(plc.run(fetch, &[]).await), ReactionError::Locked);
    subscriber
        .command("plc", r#"{"write": "marks", "fields": {"order": false}}"#)
        .await;
    let told = subscriber.json_at(&area("marks")).await;
    assert_eq!(told["fields"]["order"]["value"], json!(false), "{told}");
    while plc.fetch(Area::flags(10), 1).await.unwrap() != [0] {
        sleep(Duration::from_millis(10)).await;
    }
    assert_eq!(plc.run(fetch, &[]).await.unwrap(), [9, 9]);
    assert_eq!(subscriber.json_at(&area("marks")).await["hex"], "08 00");

    // What is not served.
    let (words, missing) = ([0; 4], ReactionError::NoSuchBlock);
    for area in [Area::db(22, 0), Area::db(20, 73), Area::db(20, 3)] {
        assert_eq!(refusal(plc.send(area, &words).await), missing, "{area}");
        assert_eq!(refusal(plc.fetch(area, 2).await), missing, "{area}");
    }
    let inputs = plc.fetch(Area::inputs(0), 1).await;
    assert_eq!(refusal(inputs), ReactionError::RequestType);
    let elsewhere = CoordinationFlag::new(12, 0).unwrap();
    let send = Command::send(Area::db(20, 4), 1).unwrap();
    let send = send.with_coordination(elsewhere.into());
    let refused = refusal(plc.run(send, &[0, 0]).await);
    assert_eq!(refused, ReactionError::AccessDenied);
}

/// Sends numbers to every gateway that connects, each until the reaction says that it was taken.
async fn send_numbers(listener: TcpListener, is_over: Arc<AtomicBool>) -> (u32, Client) {
    let mut number = 0_u32;
    loop {
        let (stream, _) = listener.accept().await.unwrap();
        stream.set_nodelay(true).unwrap();
        let plc = Client::new(stream, PARTNER, rk512::Config::DEFAULT);
        loop {
            match plc.send(Area::db(20, 0), &number.to_be_bytes()).await {
                Ok(()) if is_over.load(Ordering::Relaxed) => return (number, plc),
                Ok(()) => number += 1,
                Err(CallError::Lost(_)) => break,
                Err(_) => {}
            }
        }
    }
}

/// By line and number: the `seq`s that it came under.
type Heard = BTreeMap<(String, u32), BTreeSet<u64>>;

fn take(heard: &mut Heard, (topic, payload): &(String, Vec<u8>)) {
    if !topic.ends_with("/area/order") {
        return;
    }
    let told: Value = serde_json::from_slice(payload).unwrap();
    let number = told["fields"]["number"]["value"].as_u64().unwrap();
    let line = told["line"].as_str().unwrap().to_owned();
    let seqs = heard.entry((line, number.try_into().unwrap())).or_default();
    let is_known = !seqs.is_empty();
    if seqs.insert(told["seq"].as_u64().unwrap()) && is_known {
        assert_eq!(told["possible_repeat"], true, "{told}");
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_killed_gateway_loses_nothing_that_its_reaction_has_taken() {
    const LINES: usize = 4;
    const KILLS: u64 = 8;
    let broker = broker_or_skip!();
    let folder = TempDir::new().unwrap();
    let mut config = format!(
        "name = \"hall\"\n{}[store]\npath = \"{}\"\n",
        mqtt(broker.port),
        folder.path().display()
    );
    let is_over = Arc::new(AtomicBool::new(false));
    let mut partners = Vec::new();
    for index in 0..LINES {
        let listener = listen();
        let port = listener.local_addr().unwrap().port();
        config += &line(&format!("line{index}"), port);
        config += "procedure = \"rk512\"\n[[line.area]]\nname = \"order\"\nstart = \"DB 20.0\"\n\
                   length = 2\nserved = true\n\
                   field = [{ name = \"number\", offset = 0, type = \"u32be\" }]\n";
        partners.push(tokio::spawn(send_numbers(listener, Arc::clone(&is_over))));
    }
    let mut subscriber = Subscriber::new(broker.port).await;
    for kill in 0..KILLS {
        let gateway = Gateway::start(&config);
        gateway.logs("is open");
        sleep(Duration::from_millis(100 + 37 * kill)).await;
        drop(gateway); // SIGKILL
    }
    let _gateway = Gateway::start(&config);
    is_over.store(true, Ordering::Relaxed);
    let mut taken = Vec::new();
    for (index, partner) in partners.into_iter().enumerate() {
        let (number, plc) = partner.await.unwrap();
        // What it fetches is what it sent, and was not forgotten with the process.
        let fetched = plc.fetch(Area::db(20, 0), 2).await.unwrap();
        assert_eq!(fetched, number.to_be_bytes());
        taken.push((format!("line{index}"), number));
    }
    let mut heard = Heard::new();
    let has_all = |heard: &Heard| {
        taken.iter().all(|(line, last)| {
            (0..=*last).all(|number| heard.contains_key(&(line.clone(), number)))
        })
    };
    let total: u32 = taken.iter().map(|(_, last)| last + 1).sum();
    while let Some(message) = subscriber.next_within(Duration::from_secs(10)).await {
        take(&mut heard, &message);
        if heard.len() >= total as usize && has_all(&heard) {
            break;
        }
    }
    println!("{total} jobs, {KILLS} kills");
    assert!(has_all(&heard), "something is lost");
    assert!(taken.iter().all(|(_, last)| *last > 0), "{taken:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_reaction_says_so_where_the_store_is_full() {
    let mut broker = broker_or_skip!();
    let folder = TempDir::new().unwrap();
    let partner = Partner::new().await;
    let store = folder.path().display();
    let store = format!("[store]\npath = \"{store}\"\nmax_bytes = 1000\n");
    let line = line("plc", partner.port).replace("[[line]]", "[[line]]\nmark_repeats = false");
    let areas = AREAS.replace("poll_s = 0.2\n", "");
    let config = hall(&[&mqtt(broker.port), &store, &line, &areas]);
    // Before the gateway is there: what it delivers at once waits for this session.
    let mut subscriber = Subscriber::new(broker.port).await;
    broker.stop();
    let gateway = Gateway::start(&config);
    let stream = partner.stream().await;
    let plc = Client::new(stream, PARTNER, rk512::Config::DEFAULT);
    let mut taken = 0_u16;
    let refused = loop {
        match plc.send(Area::dx(3, 0), &taken.to_be_bytes()).await {
            Ok(()) => taken += 1,
            refused => break refusal(refused),
        }
    };
    assert_eq!(refused, ReactionError::Stopped);
    assert!((1..20).contains(&taken), "{taken}");
    gateway.logs("plc: not stored: the store is full");
    // Not that either: what was not stored was not written.
    let shown = plc.fetch(Area::dx(3, 0), 1).await.unwrap();
    assert_eq!(shown, (taken - 1).to_be_bytes());
    broker.start_again();
    while plc
        .send(Area::dx(3, 0), &taken.to_be_bytes())
        .await
        .is_err()
    {}
    for number in 0..=taken {
        let told = subscriber
            .json_at("line3964r/hall/plc/area/setpoints")
            .await;
        let hex = told["hex"].as_str().unwrap();
        assert!(hex.starts_with(&format!("00 {number:02X}")), "{told}");
        // The number of one that was refused was kept for it.
        assert_eq!(told["seq"], u64::from(number) + 1);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn an_area_that_is_kept_in_another_length_begins_with_zeros_and_that_is_said() {
    let broker = broker_or_skip!();
    let folder = TempDir::new().unwrap();
    let partner = Partner::new().await;
    let store = format!("[store]\npath = \"{}\"\n", folder.path().display());
    for (length, before, is_said) in [(2, [0; 2], false), (2, [1, 2], false), (3, [0; 2], true)] {
        let area = format!(
            "procedure = \"rk512\"\n[[line.area]]\nname = \"orders\"\nstart = \"DB 20.0\"\n\
             length = {length}\nserved = true\n"
        );
        let line = line("plc", partner.port);
        let gateway = Gateway::start(&hall(&[&mqtt(broker.port), &store, &line, &area]));
        let stream = partner.stream().await;
        let plc = Client::new(stream, PARTNER, rk512::Config::DEFAULT);
        assert_eq!(plc.fetch(Area::db(20, 0), 1).await.unwrap(), before);
        plc.send(Area::db(20, 0), &[1, 2]).await.unwrap();
        let log = gateway.ends();
        let said = "plc: area `orders`: zeros, as 4 bytes are kept, not 6";
        assert_eq!(log.contains(said), is_said, "{length} words: {log}");
    }
}
