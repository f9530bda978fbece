//! What the estimator has to know before it starts.

use crate::ffi;
use crate::Error;

/// Pinhole camera with Brown-Conrady lens, in OpenCV's conventions, and how it sits on the aircraft.
///
/// The camera that is not turned looks along body x, with image x = body y and image y = body z. It is turned by yaw about z, then
/// pitch about the new y, then roll about the newest x: a camera that looks left has a negative yaw.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Focal length along x, px; 1 to 1e5; must be set.
    pub fx_px: f32,
    /// Focal length along y, px; 1 to 1e5; must be set.
    pub fy_px: f32,
    /// Principal point, px; ±1e5; must be set.
    pub cx_px: f32,
    /// Principal point, px; ±1e5; must be set.
    pub cy_px: f32,
    /// Lens distortion, radial; ±100; default 0.
    pub k1: f32,
    /// Lens distortion, radial; ±100; default 0.
    pub k2: f32,
    /// Lens distortion, tangential; ±100; default 0.
    pub p1: f32,
    /// Lens distortion, tangential; ±100; default 0.
    pub p2: f32,
    /// Lens distortion, radial; ±100; default 0.
    pub k3: f32,
    /// Mounting, degrees; ±360; default 0.
    pub mount_yaw_deg: f32,
    /// Mounting, degrees; ±360; default 0.
    pub mount_pitch_deg: f32,
    /// Mounting, degrees; ±360; default 0.
    pub mount_roll_deg: f32,
    /// Camera relative to the pose's reference point, body axes, forward, right, down, m; each ±1e4; default 0.
    pub offset_m: [f32; 3],
    /// Width of the image, px; 0 to 1e5; must be set. 0: not known; then no box may be cut. The flight layer needs it.
    pub width_px: f32,
    /// Height of the image, px; 0 to 1e5; must be set. 0: not known, like `width_px`.
    pub height_px: f32,
    /// A box's side nearer to the border than this is not measured, fraction of the image's width; 0 to 0.5; default 0.012.
    pub border_rel: f32,
    /// While left or right is nearer to the border than this the other sides count less: [`Detector::truncation_noise_rel`]; 0 to 0.5;
    /// default 0.04.
    pub truncation_rel: f32,
}

/// How wrong the pose is, one sigma each; for the filter method.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Navigation {
    /// Constant attitude error about each body axis, mounting included, degrees; 1e-3 to 30; default 0.5.
    pub attitude_bias_sd_deg: f32,
    /// Attitude error that is new in each image, degrees; 1e-4 to 30; default 0.1.
    pub attitude_white_sd_deg: f32,
    /// Random walk of the attitude error, degrees per square root of a second; 0 to 30; default 0.
    pub attitude_walk_sd_deg: f32,
    /// Constant error of [`Pose::height_m`](crate::Pose::height_m), m; 1e-3 to 1e3; default 0.5.
    pub height_bias_sd_m: f32,
    /// Random walk of the own position, m per square root of a second; 0 to 100; default 0.05.
    pub position_walk_sd_m: f32,
    /// Error of the own position that is new in each image, each axis, m; 0 to 100; default 0.
    pub position_white_sd_m: f32,
    /// Error of the height that is new in each image, m; 0 to 1e3; default 0.5.
    pub height_white_sd_m: f32,
    /// Slope of the ground that the height is above, m per m flown; 0 to 1; default 0.01.
    pub terrain_slope_sd: f32,
    /// How far the obstacle's ground may lie off that which the height is above, m; 0 to 1e3; default 2. Boxes only.
    pub terrain_height_sd_m: f32,
    /// Constant error of the own horizontal velocity, each axis, m/s; 0 to 100; default 0.05.
    pub velocity_bias_sd_m_s: f32,
}

/// How wrong the detector's features are, one sigma each; for the filter method.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detector {
    /// Error of an image point, new in each image, px; 0.05 to 100; default 0.5.
    pub point_noise_px: f32,
    /// Error of left, right and top as points, added to it, fraction of the silhouette's width; 0 to 1; default 0.
    pub point_noise_rel: f32,
    /// Correlation of a point's error from image to image; 0 to 0.95; default 0.
    pub point_correlation: f32,
    /// How far a real silhouette departs from a cylinder's, fraction of its width; 0 to 1; default 0.
    pub shape_error_rel: f32,
    /// Error of a box's side that is new in each image, px; 0.05 to 100; default 1.
    pub box_noise_px: f32,
    /// Slowly varying (correlated) error of a side, fraction of the box's width or height; 0 to 1; default 0.07.
    pub box_noise_rel: f32,
    /// Correlation time of this error, s; 0 to 100; default 1.2.
    pub box_correlation_time_s: f32,
    /// Error of every side while the image's border cuts the box, fraction of the box; 0 to 10; default 1.
    pub truncation_noise_rel: f32,
}

/// The paper's method: least squares over the last images.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowSettings {
    /// Images in the window; 3 to 8; default 8.
    pub points: i32,
    /// Number of line points, at least `points`, after which the line replaces the disc; 1 to 1000; default 8.
    pub line_points: i32,
    /// An edge counts if its ends are farther apart, px; 0 to 1e4; default 10.
    pub edge_min_px: f32,
    /// ... and has an orientation if they differ by more in aligned y, px; 0 to 1e4; default 2.
    pub orientation_min_px: f32,
    /// Least x distance of a side's ends to its vanishing point that gives a length, px; 0.1 to 1e4; default 10.
    pub side_min_px: f32,
    /// Images that the low-pass of the orientation remembers; 1 to 1000; default 20.
    pub orientation_memory: i32,
    /// Least spread of the flown baseline, m; 1e-3 to 1e4; default 0.1.
    pub min_baseline_m: f32,
}

/// The filter method: a square-root information filter over the whole track.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSettings {
    /// Width that the range is first guessed from, m; 0.1 to 1e3; default 6.
    pub prior_width_m: f32,
    /// A point farther off is left out, sigmas; 1 to 100; default 5.
    pub gate_sigma: f32,
    /// A point farther off counts less, sigmas; 0.5 to 100; default 2.5.
    pub huber_sigma: f32,
    /// NIS ratio above which the obstacle is suspect; 0.01 to 1e3; default 1.9.
    pub nis_ratio_max: f32,
    /// Sigma over range up to which a position is reported; 0.01 to 10; default 0.25.
    pub range_sd_rel_max: f32,
    /// True: `top` is the roof's highest point in the image; false: it is the roof's nearest point; default false.
    pub top_is_highest: bool,
}

/// Which of the two methods answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// The paper's window; needs the feature `window`.
    Window,
    /// The filter; needs the feature `filter`.
    Filter,
}

impl Method {
    pub(crate) fn of(method: ffi::goe_method_t) -> Option<Self> {
        match method {
            ffi::GOE_METHOD_WINDOW => Some(Self::Window),
            ffi::GOE_METHOD_FILTER => Some(Self::Filter),
            _ => None,
        }
    }

    fn code(self) -> ffi::goe_method_t {
        match self {
            Self::Window => ffi::GOE_METHOD_WINDOW,
            Self::Filter => ffi::GOE_METHOD_FILTER,
        }
    }
}

/// Which shapes the estimator may answer with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// Filter: a prism until base corners show a box. Window: a disc until the images show enough of the base.
    Auto,
    /// Discs only.
    Disc,
    /// Window: the line through the front edge; filter: a box, and no prism before it.
    Line,
}

impl Shape {
    fn of(model: ffi::goe_model_t) -> Self {
        match model {
            ffi::GOE_MODEL_DISC => Self::Disc,
            ffi::GOE_MODEL_LINE => Self::Line,
            _ => Self::Auto,
        }
    }

    fn code(self) -> ffi::goe_model_t {
        match self {
            Self::Auto => ffi::GOE_MODEL_AUTO,
            Self::Disc => ffi::GOE_MODEL_DISC,
            Self::Line => ffi::GOE_MODEL_LINE,
        }
    }
}

/// All settings of an estimator. Settings of a part that was left out are neither read nor checked.
///
/// ```
/// let mut settings = goe::Settings::for_camera(914.0, 914.0, 640.0, 640.0, 1280.0, 1280.0);
/// settings.navigation.attitude_bias_sd_deg = 1.0;
/// assert!(goe::Estimator::new(&settings).is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The camera.
    pub camera: Camera,
    /// The method; default filter, if it is compiled in.
    pub method: Method,
    /// The shapes; default all.
    pub shape: Shape,
    /// Where Z of the trajectory's axes points: clockwise from north, degrees, ±360; `None`, the default: where the nose does at the
    /// track's first image, which is the first one that shows a feature.
    pub heading_deg: Option<f32>,
    /// Errors of the pose.
    pub navigation: Navigation,
    /// Errors of the features.
    pub detector: Detector,
    /// The window method.
    pub window: WindowSettings,
    /// The filter method.
    pub filter: FilterSettings,
}

impl Settings {
    /// The defaults, with a camera of these focal lengths, this principal point and this size of the image, px.
    #[must_use]
    pub fn for_camera(fx_px: f32, fy_px: f32, cx_px: f32, cy_px: f32, width_px: f32, height_px: f32) -> Self {
        let mut settings = Self::default();
        settings.camera.fx_px = fx_px;
        settings.camera.fy_px = fy_px;
        settings.camera.cx_px = cx_px;
        settings.camera.cy_px = cy_px;
        settings.camera.width_px = width_px;
        settings.camera.height_px = height_px;
        settings
    }

    pub(crate) fn to_c(self) -> ffi::goe_settings_t {
        ffi::goe_settings_t {
            camera: self.camera,
            method: self.method.code(),
            model: self.shape.code(),
            heading_auto: self.heading_deg.is_none(),
            heading_deg: self.heading_deg.unwrap_or(0.0),
            navigation: self.navigation,
            detector: self.detector,
            window: self.window,
            filter: self.filter,
        }
    }
}

impl Default for Settings {
    /// The library's defaults: errors of a small aircraft's usual sensors. The camera's focal lengths are 0 and must be set.
    fn default() -> Self {
        let mut c = core::mem::MaybeUninit::<ffi::goe_settings_t>::zeroed();
        // SAFETY: zeros are a goe_settings_t, and the call writes every field of it.
        let c = unsafe {
            ffi::goe_settings_default(c.as_mut_ptr());
            c.assume_init()
        };
        Self {
            camera: c.camera,
            method: Method::of(c.method).unwrap_or(Method::Filter),
            shape: Shape::of(c.model),
            heading_deg: (!c.heading_auto).then_some(c.heading_deg),
            navigation: c.navigation,
            detector: c.detector,
            window: c.window,
            filter: c.filter,
        }
    }
}

/// The name of a setting that was refused, as C has it: `"camera.fx_px"`.
pub(crate) fn bad_setting(field: *const core::ffi::c_char) -> Error {
    if field.is_null() {
        return Error::BadSetting("");
    }
    // SAFETY: the library names a field by a string constant of its own.
    let name = unsafe { core::ffi::CStr::from_ptr(field) };
    Error::BadSetting(name.to_str().unwrap_or(""))
}
