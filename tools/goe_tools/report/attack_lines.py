"""The lines of a row of hostile flights, and the figures in them: names in the files of goals."""

FLAG_S = 3.0  # a wrong convention, or late poses, are to be told within
AHEAD_S = 5.0  # a violator is to be warned so long before

# Of attacks.
COVER, WRONG, SUSPECT, ODD, REASON = "within 2 sigma", "wrong by 5 sigma", "suspect", "told as wrong", "told as moving"
LATENESS, ANSWERS, VELOCITY, TIME = "told as late", "answers", "velocity within 2 sigma", "time to go, error once told"
ANY, POSITION, TRACKS, IMAGES, OR_COVERED, EVER = "any", "position", "tracks", "images", "or covered", "ever"
FLAGGED, IN_4_S, IN_8_S, MEDIAN = f"{FLAG_S:g} s", "4 s", "8 s", "median"

# Of warnings.
TRUE_SHARE, OFF, COVERED = "true share by told", "told less true", "within 2 sigma"
UNWARNED, FALSE, FLOWN = f"unwarned {AHEAD_S:g} s ahead", "warned at 2x the margin", "flown"
