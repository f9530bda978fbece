//! Compiles the logs that tests/targets puts into its images.

fn main() {
    let logs = "../../../tests/targets";
    println!("cargo:rerun-if-changed={logs}");
    println!("cargo:rerun-if-changed=../../../lib/goe.h");
    cc::Build::new()
        .std("c99")
        .flag_if_supported("-fno-short-enums")
        .include("../../../lib")
        .file(format!("{logs}/embedded_logs.c"))
        .compile("embedded_logs");
}
