//! The layer between a detector, an autopilot and the estimators: poses of the exposures, clocks, resets, a table of obstacles,
//! hazards from now on, what to do. `port/flight/goe_flight.h` is its manual.

use core::ffi::{c_char, c_int};
use core::mem::{size_of, MaybeUninit};
use core::num::NonZeroU32;
use core::{fmt, ptr};

use crate::ffi;
use crate::image::pixel_to_c;
use crate::settings::bad_setting;
use crate::{BoundingBox, Error, Hazard, Kind, Length, Model, Pixel, Pose, Settings};

/// Obstacles that are followed at a time.
pub const SLOTS: usize = ffi::GOE_FLIGHT_SLOTS;
/// Sectors of [`Flight::sectors`], 5 degrees each, the first centered on north.
pub const SECTORS: usize = ffi::GOE_FLIGHT_SECTORS;
/// Most detections that [`Flight::frame`] takes at once.
pub const DETECTIONS: usize = ffi::GOE_FLIGHT_DETECTIONS;

/// Settings of the layer, in addition to those of the estimators.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightSettings {
    /// Detections with a lower score are ignored; 0 to 1; default 0.3.
    pub score_min: f32,
    /// Images with a new obstacle, at most 1 s apart, before it gets a slot; 1 to 20; default 3.
    pub confirm_images: f32,
    /// The detector counts as dead after this time without a frame, s; 0.05 to 60; default 1.
    pub detector_timeout_s: f32,
    /// An obstacle is dropped after this time undetected, s; 1 to 600; default 10.
    pub track_timeout_s: f32,
    /// Least time from sending to arrival, s; 0 to 0.5; default 0.005.
    pub delay_s: f32,
    /// One sigma of `delay_s`, and of a capture time without a sigma, s; 0 to 0.5; default 0.005.
    pub delay_sd_s: f32,
    /// Frames that arrive later than this after their exposure are refused, s; 0.02 to 0.5; default 0.4.
    pub delay_max_s: f32,
    /// How the autopilot reports resets: 0 by counters (PX4), 1 by times (ArduPilot); default 0.
    pub resets: f32,
    /// One sigma of the range finder, m; 0.001 to 100; default 0.3.
    pub range_finder_sd_m: f32,
    /// Greatest height at which the layer uses the range finder, m; 0 to 1000; default 40.
    pub range_finder_max_m: f32,
    /// One sigma of the terrain's height, m; 0.001 to 1000; default 3.
    pub terrain_sd_m: f32,
    /// One sigma of the height over home, m; 0.001 to 1000; default 5.
    pub home_sd_m: f32,
    /// Wanted horizontal distance to the outline, m; 0 to 1000; default 15.
    pub margin_m: f32,
    /// Wanted vertical distance over the top, m; 0 to 1000; default 10.
    pub clearance_m: f32,
    /// Least conflict probability that causes a reaction; 0.001 to 1; default 0.1.
    pub conflict_probability_max: f32,
    /// Factor on margin and clearance while the estimate is suspect; 1 to 10; default 1.5.
    pub suspect_factor: f32,
    /// Growth of margin and clearance while the estimate is not updated, m/s; 0 to 100; default 1.
    pub stale_growth_m_s: f32,
    /// Bank of an avoiding turn, degrees; 5 to 70; default 30.
    pub bank_deg: f32,
    /// Time from the order to that turn, s; 0 to 20; default 1.5.
    pub roll_in_s: f32,
    /// Rate of an avoiding climb, m/s; 0.1 to 50; default 2.5.
    pub climb_m_s: f32,
    /// Time from the order to that climb, s; 0 to 20; default 2.
    pub climb_in_s: f32,
    /// Radius of the autopilot's circle around a target, m; 0: it flies straight on; up to 1e4; default 0.
    pub loiter_m: f32,
    /// An order comes this long before the last possible moment, s; 0 to 60; default 3.
    pub reserve_s: f32,
    /// An order comes after the hazard has lasted this long, s; 0 to 10; default 0.3.
    pub confirm_s: f32,
    /// An order ends after the hazard has been over for this long, s; 0 to 60; default 2.
    pub hold_s: f32,
    /// No new order below this height above the ground, m; 0 to 1000; default 5.
    pub order_height_m: f32,
    /// No new order below this speed over the ground, m/s; 0 to 100; default 5.
    pub order_speed_m_s: f32,
}

impl Default for FlightSettings {
    fn default() -> Self {
        let mut settings = MaybeUninit::<Self>::zeroed();
        // SAFETY: the call writes every field, and they are all numbers.
        unsafe {
            ffi::goe_flight_settings_default(settings.as_mut_ptr());
            settings.assume_init()
        }
    }
}

/// A sample of the attitude.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude {
    /// Of the sample itself, not of its arrival; the autopilot's clock, microseconds; it may wrap.
    pub time_us: u32,
    /// Quaternion w, x, y, z; its norm is 1 within 1 %.
    pub q: [f32; 4],
    /// Changes with every reset of attitude or heading, which ends all tracks.
    pub reset: u32,
}

/// A place on the earth, degrees times 1e7.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatLon {
    /// Latitude.
    pub lat_e7: i32,
    /// Longitude.
    pub lon_e7: i32,
}

/// Heights of the vehicle's reference point above the ground, m; each ±1e5. The first one that is known and believed counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Heights {
    /// By a range finder.
    pub range_finder_m: Option<f32>,
    /// By a map of the terrain.
    pub terrain_m: Option<f32>,
    /// Over home.
    pub home_m: Option<f32>,
}

/// A sample of the position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PositionSample {
    /// Of the sample itself; the autopilot's clock, microseconds; it may wrap.
    pub time_us: u32,
    /// The vehicle's reference point in north, east, down, m; each ±1e6.
    pub position_ned_m: [f32; 3],
    /// Over the ground, m/s; each ±1e3.
    pub velocity_ned_m_s: [f32; 3],
    /// Heights above the ground.
    pub heights: Heights,
    /// The origin of north, east, down, if it is known.
    pub origin: Option<LatLon>,
    /// Changes with every reset of north and east.
    pub reset_horizontal: u32,
    /// Changes with every reset of down.
    pub reset_vertical: u32,
    /// New minus old of the latest reset of each, m. `None`: any reset ends all tracks.
    pub reset_delta_ned_m: Option<[f32; 3]>,
}

impl PositionSample {
    fn to_c(self) -> ffi::goe_flight_position_t {
        let heights = [self.heights.range_finder_m, self.heights.terrain_m, self.heights.home_m];
        let origin = self.origin.unwrap_or(LatLon { lat_e7: 0, lon_e7: 0 });
        ffi::goe_flight_position_t {
            time_us: self.time_us,
            position_ned_m: self.position_ned_m,
            velocity_ned_m_s: self.velocity_ned_m_s,
            height_m: heights.map(Option::unwrap_or_default),
            height_valid: (0..3).fold(0, |bits, i| bits | u8::from(heights[i].is_some()) << i),
            origin_known: self.origin.is_some(),
            origin_lat_e7: origin.lat_e7,
            origin_lon_e7: origin.lon_e7,
            reset_horizontal: self.reset_horizontal,
            reset_vertical: self.reset_vertical,
            reset_delta_known: self.reset_delta_ned_m.is_some(),
            reset_delta_ned_m: self.reset_delta_ned_m.unwrap_or_default(),
        }
    }
}

/// One obstacle in one image.
///
/// ```
/// use goe::flight::Detection;
/// use goe::BoundingBox;
/// let tower = Detection::new(0.9).with_id(7).with_box(BoundingBox::new(600.0, 400.0, 640.0, 700.0));
/// # let _ = tower;
/// ```
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Detection {
    c: ffi::goe_flight_detection_t,
}

/// A point of a [`Detection`], as of [`Image`](crate::Image).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Point {
    /// Leftmost point of the silhouette.
    Left,
    /// Rightmost point of the silhouette.
    Right,
    /// Top of the silhouette.
    Top,
    /// Left corner of the base.
    BaseLeft,
    /// Corner of the base between two visible faces.
    BaseNear,
    /// Right corner of the base.
    BaseRight,
}

impl Detection {
    /// A detection of this score, 0 to 1, without id, box or points.
    #[must_use]
    pub fn new(score: f32) -> Self {
        let invisible = pixel_to_c(None);
        Self {
            c: ffi::goe_flight_detection_t {
                id: 0,
                score,
                pixel_px: 0.0,
                box_: BoundingBox::default().to_c(),
                left: invisible,
                right: invisible,
                top: invisible,
                base_left: invisible,
                base_near: invisible,
                base_right: invisible,
                kind: Kind::default().to_c(),
            },
        }
    }

    /// The id that the detector's tracker has for it; 0: none, and the place in the image decides.
    #[must_use]
    pub fn with_id(mut self, id: u32) -> Self {
        self.c.id = id;
        self
    }

    /// One sigma of box and points, px, instead of the settings'; up to 100.
    #[must_use]
    pub fn with_pixel_px(mut self, sd_px: f32) -> Self {
        self.c.pixel_px = sd_px;
        self
    }

    /// What the detector's class says of it. A bad one is counted, and not used.
    #[must_use]
    pub fn with_kind(mut self, kind: Kind) -> Self {
        self.c.kind = kind.to_c();
        self
    }

    /// Its box in raw pixels: all four sides, also at the image's border.
    #[must_use]
    pub fn with_box(mut self, bounding_box: BoundingBox) -> Self {
        self.c.box_ = bounding_box.to_c();
        self
    }

    /// One of its points in raw pixels.
    #[must_use]
    pub fn with_point(mut self, point: Point, at: Pixel) -> Self {
        let place = match point {
            Point::Left => &mut self.c.left,
            Point::Right => &mut self.c.right,
            Point::Top => &mut self.c.top,
            Point::BaseLeft => &mut self.c.base_left,
            Point::BaseNear => &mut self.c.base_near,
            Point::BaseRight => &mut self.c.base_right,
        };
        *place = pixel_to_c(Some(at));
        self
    }
}

/// When an image was taken, the middle of its exposure, microseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Capture {
    /// By the autopilot's clock.
    Autopilot {
        /// The exposure.
        capture_us: u32,
    },
    /// By the sender's clock, which the layer compares with the arrivals, or [`Flight::timesync`] knows.
    Sender {
        /// The exposure.
        capture_us: u32,
        /// When it was sent; `capture_us` if that is not known.
        sent_us: u32,
    },
    /// By the age of the image when it was sent.
    Age {
        /// The age.
        age_us: u32,
    },
}

/// The detections of one image.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Autopilot's clock, microseconds.
    pub arrival_us: u32,
    /// When it was taken.
    pub capture: Capture,
    /// One sigma of that, microseconds; `None`: [`FlightSettings::delay_sd_s`].
    pub time_sd_us: Option<NonZeroU32>,
    /// Of detections in the whole image: of all calls with the same capture, if they do not fit one. 0: nothing in view, which
    /// shows that the detector is alive.
    pub number: u8,
    /// Those of this call; at most [`DETECTIONS`].
    pub detections: &'a [Detection],
}

impl<'a> Frame<'a> {
    /// All the detections of an image; at most 255.
    #[must_use]
    pub fn new(arrival_us: u32, capture: Capture, detections: &'a [Detection]) -> Self {
        Self {
            arrival_us,
            capture,
            time_sd_us: None,
            number: u8::try_from(detections.len()).unwrap_or(u8::MAX),
            detections,
        }
    }

    fn to_c(self) -> ffi::goe_flight_frame_t {
        let (time_base, capture_us, sent_us) = match self.capture {
            Capture::Autopilot { capture_us } => (ffi::GOE_FLIGHT_AUTOPILOT_CLOCK, capture_us, 0),
            Capture::Sender { capture_us, sent_us } => (ffi::GOE_FLIGHT_SENDER_CLOCK, capture_us, sent_us),
            Capture::Age { age_us } => (ffi::GOE_FLIGHT_AGE, age_us, 0),
        };
        ffi::goe_flight_frame_t {
            arrival_us: self.arrival_us,
            capture_us,
            sent_us,
            time_sd_us: self.time_sd_us.map_or(0, NonZeroU32::get),
            time_base,
            camera: 0,
            number: self.number,
            count: u8::try_from(self.detections.len()).unwrap_or(u8::MAX), // more than 32 are refused
            detection: self.detections.as_ptr().cast(),
        }
    }
}

/// Why a call of the layer took nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FlightError {
    /// No pose so new yet: keep the frame and ask again after the next sample.
    TooNew,
    /// Older than the history or `delay_max_s`, or in a gap of the samples: drop the frame.
    TooOld,
    /// No sample of attitude or position since the start or the latest unknown reset.
    NoPose,
    /// A sample that is not newer than the one before it.
    BadTime,
    /// A number is a NaN or an infinity.
    NotFinite,
    /// A number is outside its range.
    OutOfRange,
    /// The quaternion's norm is off 1 by more than 1 %.
    BadAttitude,
    /// No obstacle in this slot.
    Nothing,
    /// Settings in the layer's memory have changed: make another. Nothing is known, which is not "clear".
    Corrupted,
}

impl FlightError {
    fn of(status: ffi::goe_flight_status_t) -> Self {
        match status {
            ffi::GOE_FLIGHT_TOO_NEW => Self::TooNew,
            ffi::GOE_FLIGHT_TOO_OLD => Self::TooOld,
            ffi::GOE_FLIGHT_NO_POSE => Self::NoPose,
            ffi::GOE_FLIGHT_BAD_TIME => Self::BadTime,
            ffi::GOE_FLIGHT_NOT_FINITE => Self::NotFinite,
            ffi::GOE_FLIGHT_BAD_ATTITUDE => Self::BadAttitude,
            ffi::GOE_FLIGHT_NOTHING => Self::Nothing,
            ffi::GOE_FLIGHT_CORRUPTED => Self::Corrupted,
            _ => Self::OutOfRange,
        }
    }

    /// The number that C has for it.
    #[must_use]
    pub fn code(self) -> i32 {
        match self {
            Self::TooNew => ffi::GOE_FLIGHT_TOO_NEW,
            Self::TooOld => ffi::GOE_FLIGHT_TOO_OLD,
            Self::NoPose => ffi::GOE_FLIGHT_NO_POSE,
            Self::BadTime => ffi::GOE_FLIGHT_BAD_TIME,
            Self::NotFinite => ffi::GOE_FLIGHT_NOT_FINITE,
            Self::OutOfRange => ffi::GOE_FLIGHT_OUT_OF_RANGE,
            Self::BadAttitude => ffi::GOE_FLIGHT_BAD_ATTITUDE,
            Self::Nothing => ffi::GOE_FLIGHT_NOTHING,
            Self::Corrupted => ffi::GOE_FLIGHT_CORRUPTED,
        }
    }
}

impl fmt::Display for FlightError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooNew => "no pose so new yet",
            Self::TooOld => "too old",
            Self::NoPose => "no pose yet",
            Self::BadTime => "not newer than the sample before",
            Self::NotFinite => "a number is not finite",
            Self::OutOfRange => "a number is out of range",
            Self::BadAttitude => "the quaternion's norm is not 1",
            Self::Nothing => "no such obstacle",
            Self::Corrupted => "corrupted memory",
        })
    }
}

impl core::error::Error for FlightError {}

/// What to do about the worst obstacle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Action {
    /// Fly on.
    None,
    /// Fly to the target, to the left of the obstacle looking along the course.
    Left,
    /// ... right of it.
    Right,
    /// Straight on, up to the target.
    Climb,
    /// Break off the approach.
    GoAround,
    /// Turn away, to the target before the obstacle, and loiter.
    Hold,
}

impl Action {
    fn of(action: ffi::goe_flight_action_t) -> Self {
        match action {
            ffi::GOE_FLIGHT_NONE => Self::None,
            ffi::GOE_FLIGHT_LEFT => Self::Left,
            ffi::GOE_FLIGHT_RIGHT => Self::Right,
            ffi::GOE_FLIGHT_CLIMB => Self::Climb,
            ffi::GOE_FLIGHT_GO_AROUND => Self::GoAround,
            // The crate compiles its own C: no other number comes. A later one would not be leave to fly on.
            _ => Self::Hold,
        }
    }

    fn code(self) -> ffi::goe_flight_action_t {
        match self {
            Self::None => ffi::GOE_FLIGHT_NONE,
            Self::Left => ffi::GOE_FLIGHT_LEFT,
            Self::Right => ffi::GOE_FLIGHT_RIGHT,
            Self::Climb => ffi::GOE_FLIGHT_CLIMB,
            Self::GoAround => ffi::GOE_FLIGHT_GO_AROUND,
            Self::Hold => ffi::GOE_FLIGHT_HOLD,
        }
    }
}

impl fmt::Display for Action {
    /// The library's short name: `left`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // SAFETY: the library returns a string constant of its own, never null.
        let name = unsafe { core::ffi::CStr::from_ptr(ffi::goe_flight_action_text(self.code())) };
        f.write_str(name.to_str().unwrap_or("unknown"))
    }
}

/// Why it is this action.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OrderReason {
    /// No order, and none is withheld.
    None,
    /// The path of the order is clear of all known obstacles.
    Clear,
    /// No path is clear: the order has the largest distance that was found.
    LeastBad,
    /// An order is due and withheld: the aircraft is lower than `order_height_m`.
    Low,
    /// ... slower than `order_speed_m_s`.
    Slow,
    /// ... flares, or has touched down.
    Landing,
}

impl OrderReason {
    fn of(reason: ffi::goe_flight_reason_t) -> Self {
        match reason {
            ffi::GOE_FLIGHT_REASON_NONE => Self::None,
            ffi::GOE_FLIGHT_REASON_CLEAR => Self::Clear,
            ffi::GOE_FLIGHT_REASON_LOW => Self::Low,
            ffi::GOE_FLIGHT_REASON_SLOW => Self::Slow,
            ffi::GOE_FLIGHT_REASON_LANDING => Self::Landing,
            _ => Self::LeastBad,
        }
    }
}

/// What the aircraft does, for [`Flight::assess`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FlightPhase {
    /// It flies.
    #[default]
    Flying,
    /// It is landing: to go around comes first.
    Approach,
    /// No order is given, and an active one ends.
    Flare,
    /// It has touched down: the same. Obstacles behind the runway are not on its course.
    Landed,
}

impl FlightPhase {
    fn code(self) -> u8 {
        match self {
            Self::Flying => ffi::GOE_FLIGHT_FLYING,
            Self::Approach => ffi::GOE_FLIGHT_APPROACH,
            Self::Flare => ffi::GOE_FLIGHT_FLARE,
            Self::Landed => ffi::GOE_FLIGHT_LANDED,
        }
    }
}

/// What [`Flight::assess`] finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assessment {
    /// What to do.
    pub action: Action,
    /// The action needs longer than there is: it may not suffice.
    pub late: bool,
    /// The worst obstacle's estimate is suspect: margins were widened.
    pub suspect: bool,
    /// A frame came in time.
    pub detector_alive: bool,
    /// In the latest 10 s no position contradicted the velocities. If false, a convention is wrong, or the position jumped.
    pub pose_agrees: bool,
    /// The pose agrees, and samples of attitude and position came within 0.5 s.
    pub pose_alive: bool,
    /// Slot of the worst obstacle, for [`Flight::obstacle`]. `None` is "clear" only if detector and pose are alive and `unplaced`
    /// is 0.
    pub worst: Option<usize>,
    /// Slot of the obstacle that the action is about, unless it was given up.
    pub avoided: Option<usize>,
    /// Obstacles with a position.
    pub obstacles: u8,
    /// Detected obstacles without a position: no order avoids them.
    pub unplaced: u8,
    /// Time that the action needs, or the best one would, s.
    pub needed_s: f32,
    /// Where to, north, east, down, m; `None` without an action.
    pub target_ned_m: Option<[f32; 3]>,
    /// Why it is this action.
    pub reason: OrderReason,
    /// Of left, right and hold: the least distance from any known outline, two sigmas taken off, m. Otherwise 0.
    pub clear_m: f32,
    /// The target on the earth, if the origin is known.
    pub target: Option<LatLon>,
    /// Of the worst obstacle, from now.
    pub hazard: Option<Hazard>,
}

fn slot(number: i8) -> Option<usize> {
    usize::try_from(number).ok()
}

fn place(lat_e7: i32, lon_e7: i32) -> Option<LatLon> {
    (lat_e7 != 0 || lon_e7 != 0).then_some(LatLon { lat_e7, lon_e7 })
}

impl Assessment {
    fn of(c: &ffi::goe_flight_assessment_t) -> Self {
        let action = Action::of(c.action);
        let worst = slot(c.worst);
        Self {
            action,
            late: c.late,
            suspect: c.suspect,
            detector_alive: c.detector_alive,
            pose_agrees: c.pose_agrees,
            pose_alive: c.pose_alive,
            worst,
            avoided: slot(c.avoided),
            obstacles: c.obstacles,
            unplaced: c.unplaced,
            needed_s: c.needed_s,
            target_ned_m: (action != Action::None).then_some(c.target_ned_m),
            reason: OrderReason::of(c.reason),
            clear_m: c.clear_m,
            target: place(c.target_lat_e7, c.target_lon_e7),
            hazard: worst.map(|_| Hazard::of(&c.hazard)),
        }
    }
}

/// Where an obstacle is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Middle of the visible base; down: of its ground; m.
    pub center_ned_m: [f32; 3],
    /// Covariance of that: north north, north east, east east, m².
    pub covariance_ne_m2: [f32; 3],
    /// Of the circle about the center that contains the outline, m.
    pub radius_m: f32,
    /// The point of the circle nearest to the aircraft, m.
    pub nearest_ned_m: [f32; 3],
    /// The same relative to the aircraft: forward, right, down, m.
    pub nearest_body_m: [f32; 3],
    /// The center on the earth, if the origin is known.
    pub center: Option<LatLon>,
}

/// One obstacle of the table. An unknown value is `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// The detector's id; 0: it has none.
    pub id: u32,
    /// The shape.
    pub model: Option<Model>,
    /// Its sigmas may be too small.
    pub suspect: bool,
    /// On the present course its distance grows.
    pub receding: bool,
    /// Detected in the latest image.
    pub in_view: bool,
    /// It moves, and is followed.
    pub moves: bool,
    /// Since it was last measured, from the latest assessment, s.
    pub age_s: f32,
    /// Where it is.
    pub place: Option<Place>,
    /// Of its top above the ground.
    pub height: Option<Length>,
    /// Disc: diameter; box: the front edge; m.
    pub width_m: Option<f32>,
    /// The side edge, m.
    pub length_m: Option<f32>,
    /// Of the length axis, clockwise from north, degrees, 0 to 180.
    pub length_heading_deg: Option<f32>,
    /// From the latest assessment on.
    pub hazard: Option<Hazard>,
}

impl Obstacle {
    fn of(c: &ffi::goe_flight_obstacle_t) -> Self {
        let has = |bit| c.valid & bit != 0;
        Self {
            id: c.id,
            model: Model::of(c.model),
            suspect: c.suspect,
            receding: c.receding,
            in_view: c.in_view,
            moves: has(ffi::GOE_HAS_VELOCITY),
            age_s: c.age_s,
            place: has(ffi::GOE_HAS_POSITION).then(|| Place {
                center_ned_m: c.center_ned_m,
                covariance_ne_m2: c.covariance_ne_m2,
                radius_m: c.radius_m,
                nearest_ned_m: c.nearest_ned_m,
                nearest_body_m: c.nearest_body_m,
                center: place(c.lat_e7, c.lon_e7),
            }),
            height: has(ffi::GOE_HAS_HEIGHT).then_some(Length {
                m: c.height_m,
                sd_m: c.height_sd_m,
            }),
            width_m: has(ffi::GOE_HAS_WIDTH).then_some(c.width_m),
            length_m: has(ffi::GOE_HAS_LENGTH).then_some(c.length_m),
            length_heading_deg: has(ffi::GOE_HAS_ORIENTATION).then_some(c.length_heading_deg),
            hazard: c.has_hazard.then(|| Hazard::of(&c.hazard)),
        }
    }
}

/// What one sector holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sector {
    /// Outside the view of a detector that is alive, or the pose is dead. Not the same as clear.
    Unknown,
    /// Nothing there as far as the camera sees.
    Clear,
    /// The nearest obstacle, cm.
    Nearest {
        /// Its distance, cm.
        cm: u16,
    },
}

/// Counted since [`Flight::new`]; they saturate.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Frames.
    pub taken: u16,
    /// Frames that came too late for the history.
    pub late: u16,
    /// Calls that were answered by [`FlightError::TooNew`].
    pub early: u16,
    /// Samples, frames or detections that were not finite or out of range.
    pub refused: u16,
    /// Detections below `score_min`.
    pub weak: u16,
    /// Tracks that took over a new id.
    pub renumbered: u16,
    /// Tracks given up for a new obstacle.
    pub evicted: u16,
    /// Confirmed detections that found no slot.
    pub full: u16,
    /// Known jumps.
    pub resets: u16,
    /// Unknown resets and restarts: all tracks ended.
    pub lost: u16,
}

/// The pose at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseAt {
    /// The pose.
    pub pose: Pose,
    /// One sigma of its attitude, degrees.
    pub attitude_sd_deg: f32,
}

/// The flight layer. It is all the memory there is (13,760 bytes with all parts), may lie anywhere and be moved, copied or handed to
/// another thread.
#[derive(Clone)]
#[repr(transparent)]
pub struct Flight {
    c: ffi::goe_flight_t,
}

fn taken(status: ffi::goe_flight_status_t) -> Result<(), FlightError> {
    if status == ffi::GOE_FLIGHT_OK {
        Ok(())
    } else {
        Err(FlightError::of(status))
    }
}

impl Flight {
    /// Checks both settings, copies them, starts with nothing known. The camera's `width_px` and `height_px` must be set.
    ///
    /// # Errors
    /// [`Error::BadSetting`] with the name of the first setting that is outside its range.
    pub fn new(estimator: &Settings, settings: &FlightSettings) -> Result<Self, Error> {
        let mut place = MaybeUninit::uninit();
        Self::start(&mut place, estimator, settings)?;
        // SAFETY: it has been started.
        Ok(unsafe { place.assume_init() })
    }

    /// The same in memory that is there already, without a copy on the stack.
    ///
    /// # Errors
    /// As of [`Flight::new`].
    pub fn new_in<'a>(
        place: &'a mut MaybeUninit<Self>,
        estimator: &Settings,
        settings: &FlightSettings,
    ) -> Result<&'a mut Self, Error> {
        Self::start(place, estimator, settings)?;
        // SAFETY: it has been started.
        Ok(unsafe { place.assume_init_mut() })
    }

    fn start(place: &mut MaybeUninit<Self>, estimator: &Settings, settings: &FlightSettings) -> Result<(), Error> {
        let estimator = estimator.to_c();
        let mut bad: *const c_char = ptr::null();
        // SAFETY: the pointers are to places of the right types, and the size is that of the first.
        let status = unsafe {
            ffi::goe_flight_init(
                place.as_mut_ptr().cast(),
                size_of::<ffi::goe_flight_t>(),
                &estimator,
                settings,
                &mut bad,
            )
        };
        if status == ffi::GOE_FLIGHT_OK {
            Ok(())
        } else {
            Err(bad_setting(bad))
        }
    }

    /// Takes a sample of the attitude. Samples closer than 20 ms are thinned.
    ///
    /// # Errors
    /// [`FlightError::BadTime`], `NotFinite`, `BadAttitude`.
    pub fn attitude(&mut self, sample: &Attitude) -> Result<(), FlightError> {
        // SAFETY: the layer is a started one.
        taken(unsafe { ffi::goe_flight_attitude(&mut self.c, sample) })
    }

    /// Takes a sample of the position. Samples closer than 20 ms are thinned.
    ///
    /// # Errors
    /// [`FlightError::BadTime`], `NotFinite`, `OutOfRange`.
    pub fn position(&mut self, sample: &PositionSample) -> Result<(), FlightError> {
        let sample = sample.to_c();
        // SAFETY: the layer is a started one.
        taken(unsafe { ffi::goe_flight_position(&mut self.c, &sample) })
    }

    /// The pose at a time of the autopilot's clock, whose one sigma is `time_sd_us`, microseconds.
    ///
    /// # Errors
    /// [`FlightError::TooNew`], `TooOld`, `NoPose`.
    pub fn pose(&self, time_us: u32, time_sd_us: u32) -> Result<PoseAt, FlightError> {
        let mut pose = MaybeUninit::<ffi::goe_pose_t>::zeroed();
        let mut attitude_sd_deg = 0.0;
        // SAFETY: zeros are a goe_pose_t, which the call writes whole; the layer is a started one.
        let (status, pose) = unsafe {
            let status = ffi::goe_flight_pose(&self.c, time_us, time_sd_us, pose.as_mut_ptr(), &mut attitude_sd_deg);
            (status, pose.assume_init())
        };
        taken(status)?;
        Ok(PoseAt {
            pose: Pose {
                time_us: pose.time_us,
                position_ned_m: pose.position_ned_m,
                height_m: pose.height_m,
                attitude: pose.attitude,
                reset_count: pose.reset_count,
                reset_delta_ned_m: pose.reset_delta_known.then_some(pose.reset_delta_ned_m),
            },
            attitude_sd_deg,
        })
    }

    /// The sender's clock from a two-way exchange: autopilot's minus sender's, modulo 2^32, and its one sigma, microseconds; `None`:
    /// not known any more.
    pub fn timesync(&mut self, offset: Option<(u32, u32)>) {
        let (offset_us, sd_us) = offset.unwrap_or((0, u32::MAX));
        // SAFETY: the layer is a started one, so that the call cannot fail.
        unsafe { ffi::goe_flight_timesync(&mut self.c, offset_us, sd_us) };
    }

    /// Takes an image's detections, also of an image without any.
    ///
    /// # Errors
    /// [`FlightError::TooNew`] (keep the frame, call again after the next sample), `TooOld`, `NoPose`, `OutOfRange`.
    pub fn frame(&mut self, frame: &Frame<'_>) -> Result<(), FlightError> {
        let frame = frame.to_c();
        // SAFETY: the layer is a started one; the frame's pointer is to as many detections as it says, for this call.
        taken(unsafe { ffi::goe_flight_frame(&mut self.c, &frame) })
    }

    /// The hazards ahead from now on, at the velocity of the newest sample, and the reaction.
    ///
    /// `now_us`: the autopilot's clock; `phase`: what the aircraft does.
    ///
    /// # Errors
    /// [`FlightError::NoPose`]; that is not "clear".
    pub fn assess(&mut self, now_us: u32, phase: FlightPhase) -> Result<Assessment, FlightError> {
        let mut result = MaybeUninit::<ffi::goe_flight_assessment_t>::zeroed();
        // SAFETY: zeros are an assessment, which the call writes whole; the layer is a started one.
        let (status, result) = unsafe {
            let status = ffi::goe_flight_assess(&mut self.c, now_us, phase.code(), result.as_mut_ptr());
            (status, result.assume_init())
        };
        taken(status).map(|()| Assessment::of(&result))
    }

    /// One obstacle as of the latest image, with the hazard of the latest assessment. Slots are 0 to [`SLOTS`] - 1.
    ///
    /// # Errors
    /// [`FlightError::Nothing`]: there is none in this slot; `NoPose`: nothing is known of where it is now.
    pub fn obstacle(&self, slot: usize) -> Result<Obstacle, FlightError> {
        let slot = c_int::try_from(slot).map_err(|_| FlightError::Nothing)?;
        let mut obstacle = MaybeUninit::<ffi::goe_flight_obstacle_t>::zeroed();
        // SAFETY: zeros are an obstacle, which the call writes whole; the layer is a started one.
        let (status, obstacle) = unsafe {
            let status = ffi::goe_flight_obstacle(&self.c, slot, obstacle.as_mut_ptr());
            (status, obstacle.assume_init())
        };
        taken(status).map(|()| Obstacle::of(&obstacle))
    }

    /// Nearest obstacle by bearing: sector i is centered on 5 i degrees from north. `max_cm`: the distance that
    /// counts as far away, 1 to 65000.
    ///
    /// # Errors
    /// [`FlightError::NoPose`] (nothing is known), `OutOfRange`.
    pub fn sectors(&self, max_cm: u16) -> Result<[Sector; SECTORS], FlightError> {
        let mut sector_cm = [ffi::GOE_FLIGHT_SECTOR_UNKNOWN; SECTORS];
        // SAFETY: the place is of the right size; the layer is a started one.
        taken(unsafe { ffi::goe_flight_sectors(&self.c, u32::from(max_cm), &mut sector_cm) })?;
        Ok(sector_cm.map(|cm| match cm {
            ffi::GOE_FLIGHT_SECTOR_UNKNOWN => Sector::Unknown,
            cm if cm > max_cm => Sector::Clear,
            cm => Sector::Nearest { cm },
        }))
    }

    /// Changes the layer's settings in flight: poses, clocks, obstacles and a standing order stay.
    ///
    /// # Errors
    /// [`Error::BadSetting`]: its name; [`Error::Corrupted`]: the layer's memory was. The settings stay as they were.
    pub fn change_settings(&mut self, settings: &FlightSettings) -> Result<(), Error> {
        let mut bad: *const c_char = ptr::null();
        // SAFETY: the pointers are to places of the right types; the layer is a started one.
        let status = unsafe { ffi::goe_flight_change_settings(&mut self.c, settings, &mut bad) };
        match status {
            ffi::GOE_FLIGHT_OK => Ok(()),
            ffi::GOE_FLIGHT_CORRUPTED => Err(Error::Corrupted),
            _ => Err(bad_setting(bad)),
        }
    }

    /// Forgets poses, clocks, obstacles and the reaction; keeps settings and counters. After a restart of the autopilot.
    pub fn restart(&mut self) {
        // SAFETY: the layer is a started one, so that the call cannot fail.
        unsafe { ffi::goe_flight_restart(&mut self.c) };
    }

    /// The counters so far.
    #[must_use]
    pub fn counters(&self) -> Counters {
        // SAFETY: the call returns the address of a field of the layer.
        unsafe { *ffi::goe_rust_counters(&self.c) }
    }
}

impl fmt::Debug for Flight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Flight")
            .field("counters", &self.counters())
            .finish_non_exhaustive()
    }
}

const _: () = {
    const fn goes_to_other_threads<T: Send + Sync>() {}
    goes_to_other_threads::<Flight>()
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_action_is_no_leave_to_fly_on() {
        for code in 0..=5 {
            assert_eq!(Action::of(code).code(), code);
        }
        assert_eq!(Action::of(6), Action::Hold);
        assert_eq!(Action::of(u32::MAX), Action::Hold);
    }
}
