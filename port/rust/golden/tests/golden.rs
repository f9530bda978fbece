//! Through the crate's safe types the logs give the hashes that C gives.

use std::fs;

fn golden(file: &str) -> String {
    let text = fs::read_to_string(format!("../../../tests/targets/{file}")).expect("a hash");
    text.lines().next().expect("a line").to_string()
}

#[test]
fn estimates_have_the_bits_of_c() {
    let (hash, images) = goe_golden::replay();
    assert!(images > 1000);
    assert_eq!(format!("{hash:016x}"), golden("golden_hash.txt"));
}

#[test]
fn the_flight_layer_has_the_bits_of_c() {
    let (hash, frames) = goe_golden::replay_flight();
    assert!(frames > 600);
    assert_eq!(format!("{hash:016x}"), golden("flight_hash.txt"));
}
