"""Names of the lines of hostile flights, and of the figures in them, in the files of goals."""

FLAG_S = 3.0  # limit for the report of a wrong convention or of late poses
AHEAD_S = 5.0  # required time from the warning to the violation

# Of attacks.
COVER, WRONG, SUSPECT = "within 2 sigma", "wrong by 5 sigma", "suspect"
ODD, REASON, LATENESS = "flagged as wrong", "flagged as moving", "flagged as late"
ANSWERS, VELOCITY, TIME = "answers", "velocity within 2 sigma", "time to go, error once flagged"
TYPICAL, SHORT = "median error in sigmas", "short of covered or flagged"
LATENCY, FOLLOWED = "latency within 2 sigma", "place now within 2 sigma"
ANY, POSITION, TRACKS, IMAGES, OR_COVERED, EVER = "any", "position", "tracks", "images", "or covered", "ever"
FLAGGED, IN_4_S, IN_8_S, MEDIAN = f"{FLAG_S:g} s", "4 s", "8 s", "median"

# Of warnings.
TRUE_SHARE, OFF, COVERED = "true share by predicted", "predicted less true", "within 2 sigma"
UNWARNED, FALSE, FLOWN = f"unwarned {AHEAD_S:g} s ahead", "warned at 2x the margin", "flown"

TITLES = {  # on the page
    ODD: "reported as wrong", REASON: "reported as moving", LATENESS: "reported as late",
    TIME: "time to go, error after that report",
}  # fmt: skip
