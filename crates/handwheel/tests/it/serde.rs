//! Serialised numbers are checked when they are read.

use handwheel::{Key, Position, Report, Status, Timeouts};

#[test]
fn reports_come_back_and_numbers_are_checked() {
    let (w1, w2) = (Position::new(3).unwrap(), Position::MAX);
    let report = Report::Status(Status::Hbls { key: None, w1, w2 });
    let text = serde_json::to_string(&report).unwrap();
    assert_eq!(text, r#"{"Status":{"Hbls":{"key":null,"w1":3,"w2":12}}}"#);
    assert_eq!(serde_json::from_str::<Report>(&text).unwrap(), report);
    let error = serde_json::from_str::<Key>("21").unwrap_err().to_string();
    assert!(error.starts_with("key 21 is not within 1..=20"), "{error}");
    let timeouts = serde_json::to_string(&Timeouts::DEFAULT).unwrap();
    let read: Timeouts = serde_json::from_str(&timeouts).unwrap();
    assert_eq!(read, Timeouts::DEFAULT);
}
