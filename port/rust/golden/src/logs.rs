//! `tests/targets/embedded_logs.h` in Rust.

use core::ffi::{c_char, c_int};
use core::ptr::addr_of;

use goe::{BoundingBox, Image, Method, Pixel, Pose, Settings, Shape};

#[repr(C)]
pub struct LoggedImage {
    pub time_us: i64,
    seen: u8,
    bounding_box: u8,
    reset_count: u8,
    reset_delta_known: u8,
    bits: [u32; 23],
}

#[repr(C)]
pub struct LoggedTrack {
    name: *const c_char,
    first: i16,
    count: i16,
    model: u8,
    window: u8,
    line_points: u8,
    orientation_memory: u8,
    heading_auto: u8,
    position_white_sd_m: u8,
    bits: [u32; 18],
}

extern "C" {
    // Where the arrays begin; how long they are C alone knows.
    static logged_images: [LoggedImage; 0];
    static logged_tracks: [LoggedTrack; 0];
    static logged_track_count: c_int;
}

pub fn tracks() -> impl Iterator<Item = &'static LoggedTrack> {
    // SAFETY: the array has as many elements, and nobody writes it.
    (0..unsafe { logged_track_count } as usize)
        .map(|i| unsafe { &*addr_of!(logged_tracks).cast::<LoggedTrack>().add(i) })
}

fn numbers<const N: usize>(bits: &[u32]) -> [f32; N] {
    core::array::from_fn(|i| f32::from_bits(bits[i]))
}

impl LoggedTrack {
    pub fn images(&self) -> &'static [LoggedImage] {
        // SAFETY: the track's images lie within the array, which nobody writes.
        unsafe {
            let first = addr_of!(logged_images).cast::<LoggedImage>().add(self.first as usize);
            core::slice::from_raw_parts(first, self.count as usize)
        }
    }

    pub fn settings(&self, method: Method) -> Settings {
        let n: [f32; 18] = numbers(&self.bits);
        let mut settings = Settings::for_camera(n[0], n[1], n[2], n[3], n[16], n[17]);
        let camera = &mut settings.camera;
        [camera.k1, camera.k2, camera.p1, camera.p2, camera.k3] = [n[4], n[5], n[6], n[7], n[8]];
        [camera.mount_yaw_deg, camera.mount_pitch_deg, camera.mount_roll_deg] = [n[9], n[10], n[11]];
        camera.offset_m = [n[12], n[13], n[14]];
        settings.heading_deg = (self.heading_auto == 0).then_some(n[15]);
        settings.method = method;
        settings.shape = match self.model {
            1 => Shape::Auto,
            2 => Shape::Disc,
            _ => Shape::Line,
        };
        settings.window.points = i32::from(self.window);
        settings.window.line_points = i32::from(self.line_points);
        settings.window.orientation_memory = i32::from(self.orientation_memory);
        settings.navigation.position_white_sd_m = f32::from(self.position_white_sd_m);
        settings
    }
}

impl LoggedImage {
    pub fn image(&self) -> Image {
        let n: [f32; 23] = numbers(&self.bits);
        let point = |i: usize| {
            let at = Pixel {
                u_px: n[11 + 2 * i],
                v_px: n[12 + 2 * i],
            };
            (self.seen >> i & 1 != 0).then_some(at)
        };
        let side = |i: usize| (self.bounding_box >> i & 1 != 0).then_some(n[11 + i]);
        Image {
            pose: Pose {
                time_us: self.time_us,
                position_ned_m: [n[0], n[1], n[2]],
                height_m: n[3],
                attitude: [n[4], n[5], n[6], n[7]],
                reset_count: self.reset_count,
                reset_delta_ned_m: (self.reset_delta_known != 0).then_some([n[8], n[9], n[10]]),
            },
            left: point(0),
            right: point(1),
            top: point(2),
            base_left: point(3),
            base_near: point(4),
            base_right: point(5),
            bounding_box: (self.bounding_box != 0).then(|| BoundingBox {
                left_px: side(0),
                top_px: side(1),
                right_px: side(2),
                bottom_px: side(3),
            }),
            ..Image::default()
        }
    }
}
