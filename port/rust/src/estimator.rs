//! The estimator of one obstacle.

use core::ffi::c_char;
use core::mem::{size_of, MaybeUninit};
use core::{fmt, ptr};

use crate::ffi;
use crate::settings::bad_setting;
#[cfg(not(feature = "hazard"))]
use crate::Error;
#[cfg(feature = "hazard")]
use crate::{Decision, DecisionRule, Error, Hazard, Intent};
use crate::{Estimate, Fault, Image, Settings};

/// Follows one obstacle. It is all the memory there is (at most 1,952 bytes), may lie anywhere and be moved, copied or handed to
/// another thread.
#[derive(Clone)]
#[repr(transparent)]
pub struct Estimator {
    c: ffi::goe_estimator_t,
}

/// Quantities of [`Estimator::covariance`], in this order: X0, Z0 in m, orientation in degrees, width, length, height in m.
pub const QUANTITIES: usize = ffi::GOE_QUANTITIES;

impl Estimator {
    /// Checks the settings, copies them and starts with an empty track and zeroed counters.
    ///
    /// # Errors
    /// [`Error::BadSetting`] with the name of the first setting that is outside its range, or requires a method that was left out.
    pub fn new(settings: &Settings) -> Result<Self, Error> {
        let mut place = MaybeUninit::uninit();
        Self::start(&mut place, settings)?;
        // SAFETY: it has been started.
        Ok(unsafe { place.assume_init() })
    }

    /// The same in memory that is there already, without a copy on the stack.
    ///
    /// ```
    /// use core::mem::MaybeUninit;
    /// let settings = goe::Settings::for_camera(914.0, 914.0, 640.0, 640.0, 1280.0, 1280.0);
    /// let mut place = MaybeUninit::uninit();
    /// let tower: &mut goe::Estimator = goe::Estimator::new_in(&mut place, &settings)?;
    /// # tower.reset();
    /// # Ok::<(), goe::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`Estimator::new`].
    pub fn new_in<'a>(place: &'a mut MaybeUninit<Self>, settings: &Settings) -> Result<&'a mut Self, Error> {
        Self::start(place, settings)?;
        // SAFETY: it has been started.
        Ok(unsafe { place.assume_init_mut() })
    }

    fn start(place: &mut MaybeUninit<Self>, settings: &Settings) -> Result<(), Error> {
        let settings = settings.to_c();
        let mut bad: *const c_char = ptr::null();
        // SAFETY: the pointers are to places of the right types, and the size is that of the first.
        let status = unsafe {
            ffi::goe_init(
                place.as_mut_ptr().cast(),
                size_of::<ffi::goe_estimator_t>(),
                &settings,
                &mut bad,
            )
        };
        if status == ffi::GOE_OK {
            Ok(())
        } else {
            Err(bad_setting(bad))
        }
    }

    /// Takes one image, also one without a detection, and returns the estimate after it.
    ///
    /// # Errors
    /// [`Fault`]: the image gave no new solution; it carries the last good estimate, and [`Status`](crate::Status) gives the reason.
    pub fn update(&mut self, image: &Image) -> Result<Estimate, Fault> {
        let image = image.to_c();
        let mut answer = MaybeUninit::<ffi::goe_estimate_t>::zeroed();
        // SAFETY: zeros are a goe_estimate_t, which the call writes whole; the estimator is a started one.
        let (status, answer) = unsafe {
            let status = ffi::goe_update(&mut self.c, &image, answer.as_mut_ptr());
            (status, answer.assume_init())
        };
        let estimate = Estimate::of(status, &answer);
        if status < 0 {
            Err(Fault { estimate })
        } else {
            Ok(estimate)
        }
    }

    /// Covariance of the latest estimate, by [`QUANTITIES`]; `None`: there is no position, or the memory is
    /// corrupted. Rows and columns of invalid quantities are 0.
    #[must_use]
    pub fn covariance(&self) -> Option<[[f32; QUANTITIES]; QUANTITIES]> {
        let mut covariance = [[0.0; QUANTITIES]; QUANTITIES];
        // SAFETY: the place is of the right size, the estimator a started one.
        let status = unsafe { ffi::goe_covariance(&self.c, &mut covariance) };
        (status == ffi::GOE_OK).then_some(covariance)
    }

    /// Closest approach to the obstacle of the latest estimate, stale or not, suspect or not.
    ///
    /// # Errors
    /// [`Error::NoPosition`] and [`Error::Corrupted`], which do not mean that it is safe; [`Error::NotFinite`] and
    /// [`Error::OutOfRange`] of the intent.
    #[cfg(feature = "hazard")]
    pub fn hazard(&self, intent: &Intent) -> Result<Hazard, Error> {
        let intent = intent.to_c();
        let mut hazard = MaybeUninit::<ffi::goe_hazard_t>::zeroed();
        // SAFETY: zeros are a goe_hazard_t, which the call writes whole; the estimator is a started one.
        let (status, hazard) = unsafe {
            let status = ffi::goe_hazard(&self.c, &intent, hazard.as_mut_ptr());
            (status, hazard.assume_init())
        };
        match status {
            ffi::GOE_OK => Ok(Hazard::of(&hazard)),
            ffi::GOE_NOT_FINITE => Err(Error::NotFinite),
            ffi::GOE_OUT_OF_RANGE => Err(Error::OutOfRange),
            ffi::GOE_CORRUPTED => Err(Error::Corrupted),
            _ => Err(Error::NoPosition),
        }
    }

    /// The decision rule: whether to act now, and the hazard with the intent's margin and clearance widened by doubt and age. To be
    /// asked after each image, also after one without a detection. `None`: there is no hazard, which does not mean that it is safe.
    ///
    /// ```
    /// # use goe::{DecisionRule, Estimator, Intent, Settings};
    /// # let tower = Estimator::new(&Settings::for_camera(914.0, 914.0, 640.0, 640.0, 1280.0, 1280.0))?;
    /// # let mut go_around = false;
    /// let intent = Intent { velocity_ned_m_s: [16.0, 0.0, 0.0], margin_m: 15.0, clearance_m: 10.0, ..Intent::default() };
    /// let (decision, hazard) = tower.decide(&intent, &DecisionRule::default());
    /// go_around = decision.acts(go_around);
    /// # assert!(!go_around && hazard.is_none());
    /// # Ok::<(), goe::Error>(())
    /// ```
    #[cfg(feature = "hazard")]
    pub fn decide(&self, intent: &Intent, rule: &DecisionRule) -> (Decision, Option<Hazard>) {
        let (intent, rule) = (intent.to_c(), rule.to_c());
        let mut hazard = MaybeUninit::<ffi::goe_hazard_t>::zeroed();
        // SAFETY: zeros are a goe_hazard_t, which the call writes whole; the estimator is a started one.
        let (decision, hazard) = unsafe {
            let decision = ffi::goe_decide(&self.c, &intent, &rule, hazard.as_mut_ptr());
            (Decision::of(decision), hazard.assume_init())
        };
        let known = hazard.dcpa_sd_m > 0.0; // all zero without one
        (decision, known.then(|| Hazard::of(&hazard)))
    }

    /// Forgets the track; keeps settings and counters. For another obstacle, or a new view of the same one.
    pub fn reset(&mut self) {
        // SAFETY: the estimator is a started one. If its memory is corrupted, every call says so.
        unsafe { ffi::goe_reset(&mut self.c) };
    }

    /// Faults so far, for the flight log: `[-code]` of each [`Status`](crate::Status) from -1 to -15, `[0]` the tracks that a filter
    /// reset of unknown size ended. They saturate.
    #[must_use]
    pub fn fault_counts(&self) -> [u32; ffi::GOE_FAULT_COUNTS] {
        // SAFETY: the call returns the address of a field of the estimator.
        unsafe { *ffi::goe_rust_fault_counts(&self.c) }
    }
}

impl fmt::Debug for Estimator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Estimator")
            .field("fault_counts", &self.fault_counts())
            .finish_non_exhaustive()
    }
}

const _: () = {
    const fn goes_to_other_threads<T: Send + Sync>() {}
    goes_to_other_threads::<Estimator>()
};
