//! Flies the embedded logs through the safe types and hashes every bit that comes out, as `tests/targets/replay.c` and
//! `flight_main.c` do in C: what a safe type lost or turned round would change the hash.
#![cfg_attr(target_os = "none", no_std)]

mod estimates;
mod hash;
mod layer;
mod logs;

pub use estimates::replay;
pub use layer::replay as replay_flight;

/// The hash, and how many images it is over.
pub type Replayed = (u64, u32);

#[cfg(target_os = "none")]
mod image {
    extern "C" {
        fn port_write_text(text: *const core::ffi::c_char);
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo) -> ! {
        // SAFETY: the text ends with a zero.
        unsafe { port_write_text(c"panic\n".as_ptr()) };
        loop {}
    }

    fn write(name: &core::ffi::CStr, (hash, images): super::Replayed) {
        let mut digits = [0; 34];
        for (i, digit) in digits.iter_mut().take(16).enumerate() {
            *digit = b"0123456789abcdef"[(hash >> (60 - 4 * i)) as usize & 15];
        }
        digits[16] = b' ';
        let mut rest = images;
        for at in (17..22).rev() {
            digits[at] = b'0' + (rest % 10) as u8;
            rest /= 10;
        }
        digits[22] = b'\n';
        // SAFETY: both texts end with a zero.
        unsafe {
            port_write_text(name.as_ptr());
            port_write_text(digits.as_ptr().cast());
        }
    }

    /// What the start-up code of port/baremetal calls.
    #[no_mangle]
    pub extern "C" fn main() -> i32 {
        write(c"replay ", super::replay());
        write(c"flight ", super::replay_flight());
        goe::self_check() as i32
    }
}
