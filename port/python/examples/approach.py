# %% [markdown]
# # Flying towards a mast
#
# A small aircraft flies north at 16 m/s, 15 m above the ground, towards a mast of 6 m by 30 m. A detector draws a box
# around it, 8 times a second, with errors of its own. What does the estimator know, when, how surely, and when is it
# time to go around?
#
# Run it as it is, or cell by cell in an editor that knows `# %%`.

# %%
import goe
import numpy as np

FOCAL_PX, CENTER_PX = 914.0, 640.0
SPEED_M_S, HEIGHT_M = 16.0, 15.0
MAST_NORTH_M, MAST_EAST_M, MAST_WIDTH_M, MAST_HEIGHT_M = 250.0, -4.0, 6.0, 30.0
IMAGES, RATE_HZ = 100, 8.0

print(f"goe {goe.__version__}; arithmetic {'as on every target' if goe.self_check() == 0 else 'of another kind'}")

# %% [markdown]
# ## The images
#
# A pinhole camera that looks ahead, level. Columns of numbers, one row an image: that is all the package wants.


# %%
def approach(east_m: float, seed: int) -> goe.Images:
    """The flight past a mast `east_m` to the right of the path: boxes with 1 px of noise in each image, and with an
    error of 3 % of the box, correlated over about a second."""
    random = np.random.default_rng(seed)
    time_s = np.arange(IMAGES) / RATE_HZ
    ahead_m = MAST_NORTH_M - SPEED_M_S * time_s - MAST_WIDTH_M / 2
    sides_m = np.array([east_m - MAST_WIDTH_M / 2, HEIGHT_M - MAST_HEIGHT_M, east_m + MAST_WIDTH_M / 2, HEIGHT_M])
    box_px = CENTER_PX + FOCAL_PX * sides_m / ahead_m[:, None]  # left, top, right, bottom
    size_px = box_px[:, [2, 3, 2, 3]] - box_px[:, [0, 1, 0, 1]]
    alike = np.zeros((IMAGES, 4))
    keep = np.exp(-1.0 / (RATE_HZ * 1.2))
    for k in range(IMAGES):
        alike[k] = keep * alike[k - 1] + np.sqrt(1.0 - keep**2) * random.normal(0.0, 0.03, 4)
    still = np.zeros((IMAGES, 2))
    return goe.Images(
        time_us=np.rint(1e6 * time_s).astype(np.int64),
        position_ned_m=np.column_stack([SPEED_M_S * time_s, still[:, 0], still[:, 1] - HEIGHT_M]),
        attitude=np.tile([1.0, 0.0, 0.0, 0.0], (IMAGES, 1)),
        height_m=np.full(IMAGES, HEIGHT_M),
        box_px=box_px + size_px * alike + random.normal(0.0, 1.0, (IMAGES, 4)),
        velocity_ned_m_s=np.tile([SPEED_M_S, 0.0, 0.0], (IMAGES, 1)),
    )


images = approach(MAST_EAST_M, seed=1)

# %% [markdown]
# ## The estimate after each image
#
# The settings define the sensor errors: the sigmas are only as good as these. One call takes the whole track. The
# decision rule evaluates straight flight after each image, with margins that grow while the estimate
# is in doubt or old.

# %%
settings = goe.Settings.for_camera(FOCAL_PX, FOCAL_PX, CENTER_PX, CENTER_PX, width_px=1280, height_px=1280)
settings.detector.box_noise_px = 1.0
settings.detector.box_noise_rel = 0.03
CLIMB_S = 8.0  # what a climb takes, and some seconds to decide
rule = goe.Rule(margin_m=15.0, clearance_m=10.0, act_within_s=CLIMB_S)
track = goe.run(settings, images, rules=[rule], covariance=True)

true_m = MAST_NORTH_M - SPEED_M_S * np.arange(IMAGES) / RATE_HZ
for k in range(0, IMAGES, 10):
    estimate, hazard = track[k], track.hazard(k)
    if estimate.position is None or hazard is None:
        print(f"{k / RATE_HZ:5.2f} s  {estimate.status}")
        continue
    ahead, width = estimate.position.z, estimate.width
    print(
        f"{k / RATE_HZ:5.2f} s  {ahead.m:6.1f} +- {ahead.sd_m:4.1f} m ahead (true {true_m[k]:6.1f}), "
        f"{'' if width is None else f'{width.m:4.1f} m wide, '}{hazard.tcpa_s:4.1f} s to go, "
        f"violation {hazard.conflict_probability:.2f}"
    )

# %% [markdown]
# ## Going around
#
# The first image after which the rule says so: both margins will be violated, with a probability of 10 %, sooner than a
# climb takes.

# %%
act = track.decision[:, 0] == goe.Decision.ACT
order = int(np.argmax(act)) if act.any() else None
if order is not None:
    left_s, left_m = track.hazards["tcpa_s"][order, 0], true_m[order]
    print(f"go around at {order / RATE_HZ:.2f} s: {left_s:.1f} s to go, {left_m:.0f} m before the mast")

# %% [markdown]
# ## Is the sigma honest?
#
# Many flights with other noise, in threads; each has an estimator of its own, and the bits are those of one after the
# other.

# %%
flights = [approach(MAST_EAST_M, seed) for seed in range(40)]
answers = goe.run_parallel(settings, flights, rules=[rule])
errors = np.array([answer.estimates["z_m"] - true_m for answer in answers])
sigmas = np.array([np.where(answer.valid[:, 1], answer.estimates["sigma"]["z_m"], np.nan) for answer in answers])
known = np.isfinite(sigmas)
share = np.mean(np.abs(errors[known]) < 2.0 * sigmas[known])
print(f"{len(flights)} flights: the true range lies within two sigma in {100 * share:.0f} % of {known.sum()} answers")

# %% [markdown]
# ## In flight
#
# One image at a time, as it comes: the same answers. Only a decision for "clear" ends an action.

# %%
mast = goe.Estimator(settings)
straight_on = goe.Intent((SPEED_M_S, 0.0, 0.0), margin_m=15.0, clearance_m=10.0)
go_around = False
for k in range(IMAGES):
    pose = goe.Pose(int(images.time_us[k]), images.position_ned_m[k], HEIGHT_M, images.attitude[k])
    latest = mast.update(goe.Image(pose, bounding_box=goe.BoundingBox(*images.box_px[k])))
    decision, hazard = mast.decide(straight_on, goe.DecisionRule(act_within_s=CLIMB_S))
    assert decision == track.decision[k, 0]
    go_around = decision == goe.Decision.ACT or (go_around and decision != goe.Decision.CLEAR)
assert latest == track[-1] and go_around
if hazard is not None:
    print(f"at the end: {hazard.tcpa_s:.1f} +- {hazard.tcpa_sd_s:.1f} s to go, misses by {hazard.dcpa.m:.1f} m")
