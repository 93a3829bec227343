"""Two outlines that touch: features on body i, runs on body j, and their nearest pair.

A feature is a line, a convex arc (radius R >= 0; a convex corner is one of radius 0) or a concave arc. A run is a row
of convex arcs that follow each other: a corner, a rounded corner, a lobe, a circle. Each place where two bodies touch
is one of a run on a feature. The arc of a run that faces the feature is a circle about c with radius r; where none
faces it, the run's end is a point (r = 0). With w from the feature's begin, or centre, to c, tangent t and normal n
outwards:

    line      gap = n . w - r               foot s = t . w                  slid = s + r (phi - a)
    convex    gap = |w| - R - r             foot s = R theta                slid = R theta + r (phi - a)
    concave   gap = R - |w| - r             foot s = -R theta               slid = -R theta + r (phi - a)

theta: angle of w;  phi: angle of -n;  a: angle of marker j. A pair counts where the foot is on the feature, and a
negative gap where the run enters the outline there. Where the pair is a corner on a corner, or a feature that is left
out because the run is in the other row, nothing can touch there: the gap is that distance and a little more.

Two rows of the same runs have the deepest or nearest pair and the next one, whose foot is at another place of the
outline. While a row is closed it keeps its pair and goes on to the next feature only where the normal does not jump;
ROOM is how far (m) it is from where that ends, as at the tip of a tooth, and is an event
(mbsd/dynamics/events/outlines.py). Codes of the pair of a row and of that of its sibling are in LAST.

Numbers, from OWN on: counts of runs, elements and features; 1 in the second of two rows of the same runs, else 0; gap
where there is none; how far features reach beyond concave corners (m); the little more (m); the depth beyond which a
pair is none (m); what the way grows by in a round of the outline (m); then runs, elements and features with the columns
below.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal
from mbsd.equations.relative.equation import FA, FAA, FX, FXA, FXX, FXY, FY, FYA, FYY, OWN, A, F, X, Y, clear
from mbsd.equations.system import LAST

RUNS, ELEMENTS, FEATURES, SECOND, NOWHERE, BEYOND, MORE, DEEPEST, ROUND, TABLES = range(OWN, OWN + 10)
FIRST, END, RUN_X, RUN_Y, RUN_REACH, CLOSED, RUN_LENGTH, RUN_WIDTH = range(8)
"""Columns of a run: first element and the one after its last, a circle around it, 1 if it is a closed loop and then its
length (m), else 0."""
AT_X, AT_Y, RADIUS, U0X, U0Y, U1X, U1Y, LENGTH, ANGLE, ELEMENT_WIDTH = range(10)
"""Columns of an element: centre and radius, unit normals at its begin and end, length (m) and turn (rad) of the run up
to it; ANGLE: direction of the run's first normal, and of it to that of this element."""
KIND, FEATURE_X, FEATURE_Y, T0X, T0Y, T1X, T1Y, SIZE, ARC, LINKED, SPAN, CIRCLE_X, CIRCLE_Y, REACH, LEFT_OUT, PHI = (
    range(16)
)
"""Columns of a feature: LINE, CONVEX or CONCAVE; begin of the line, else the centre; tangent of the line, else unit
vectors from the centre to begin and end; length or radius; arc length at its begin; 1 if the next goes on from its end
without a jump of the normal, 0 at a concave corner; length (m), or angle (rad) of an arc; a circle around it; 1 if it
is left out; angle of -n at its begin."""
FEATURE_WIDTH = 16
LINE, CONVEX, CONCAVE = 0.0, 1.0, -1.0
PLACE, ROOM, FACING, USED_END, CR, QX, QY, WX, WY, FOOT = range(4, 14)
"""Scratch after the relative pose: code of the pair (0: none), room (m), 1 if an arc faces the feature, else the end of
the run that is used; radius of the circle and its centre from marker j in the axes of i, w, and the foot's s (an angle
on arcs)."""
FACES, BEGIN, FINISH = 0, 1, 2
"""Parts of a run: the arc that faces a feature, or the deeper end where none does; its ends."""
SAME, APART = 0, 1
CODES = 1 << 24
ROUNDING, NEAR_END, PASSING = 1e-9, 1e-6, 1e-3
"""Parts of a size within which a foot is on a feature, or at its end, or where a corner passes that end."""


@internal
def run_at(numbers, run):
    """Return where a run's numbers begin."""
    return TABLES + RUN_WIDTH * run


@internal
def _element_at(numbers, element):
    return TABLES + RUN_WIDTH * int(numbers[RUNS]) + ELEMENT_WIDTH * element


@internal
def feature_at(numbers, feature):
    """Return where a feature's numbers begin."""
    elements = TABLES + RUN_WIDTH * int(numbers[RUNS])
    return elements + ELEMENT_WIDTH * int(numbers[ELEMENTS]) + FEATURE_WIDTH * feature


@internal
def _code(run, feature):
    return 1 + run * 4096 + feature


@internal
def _is_corner(numbers, row):
    """Return True if a run is one corner alone."""
    return numbers[row + RUN_REACH] == 0.0


@internal
def _faces(numbers, e, dx, dy):
    """Return True if an element's normals include the direction (dx, dy) of marker j's axes."""
    near = ROUNDING * (abs(dx) + abs(dy))
    after = numbers[e + U0X] * dy - numbers[e + U0Y] * dx
    before = dx * numbers[e + U1Y] - dy * numbers[e + U1X]
    ahead = (numbers[e + U0X] + numbers[e + U1X]) * dx + (numbers[e + U0Y] + numbers[e + U1Y]) * dy
    return after >= -near and before >= -near and ahead > 0.0


@internal
def _measure(numbers, relative, f, px, py, r):
    """Return the gap of a circle of radius r at (px, py) of marker j from feature f; notes its foot."""
    c = math.cos(relative[A])
    s = math.sin(relative[A])
    qx = c * px - s * py
    qy = s * px + c * py
    relative[QX] = qx
    relative[QY] = qy
    relative[CR] = r
    wx = relative[X] + qx - numbers[f + FEATURE_X]
    wy = relative[Y] + qy - numbers[f + FEATURE_Y]
    relative[WX] = wx
    relative[WY] = wy
    if numbers[f + KIND] == LINE:
        relative[FOOT] = numbers[f + T0X] * wx + numbers[f + T0Y] * wy
        return numbers[f + T0Y] * wx - numbers[f + T0X] * wy - r
    turn = math.atan2(numbers[f + T0X] * wy - numbers[f + T0Y] * wx, numbers[f + T0X] * wx + numbers[f + T0Y] * wy)
    length = math.sqrt(wx * wx + wy * wy)
    relative[FOOT] = turn * numbers[f + KIND]
    return numbers[f + KIND] * (length - numbers[f + SIZE]) - r


@internal
def stand(numbers, relative, run, f, choice):
    """Return the gap of a run from feature f, wherever the foot is, and note which arc faces it.

    ``choice``: what of the run is used.
    """
    row = run_at(numbers, run)
    first = int(numbers[row + FIRST])
    end = int(numbers[row + END])
    relative[USED_END] = choice
    relative[FACING] = 0.0
    if choice == BEGIN:
        return _measure_end(numbers, relative, f, first, U0X)
    if choice == FINISH:
        return _measure_end(numbers, relative, f, end - 1, U1X)
    c = math.cos(relative[A])
    s = math.sin(relative[A])
    kind = numbers[f + KIND]
    if kind == LINE:
        dx = -numbers[f + T0Y]
        dy = numbers[f + T0X]
    else:
        dx = numbers[f + FEATURE_X] - relative[X]
        dy = numbers[f + FEATURE_Y] - relative[Y]
    jx = c * dx + s * dy
    jy = c * dy - s * dx
    alone = _is_corner(numbers, row)
    best = -1
    least = math.inf
    for k in range(first, end):
        e = _element_at(numbers, k)
        if kind == LINE:
            faces = alone or _faces(numbers, e, jx, jy)
        else:
            faces = alone or _faces(numbers, e, kind * (jx - numbers[e + AT_X]), kind * (jy - numbers[e + AT_Y]))
        if faces:
            gap = _measure(numbers, relative, f, numbers[e + AT_X], numbers[e + AT_Y], numbers[e + RADIUS])
            near = ROUNDING * numbers[f + SPAN]
            if relative[FOOT] < -near or relative[FOOT] > numbers[f + SPAN] + near:
                gap += numbers[NOWHERE]
            if abs(gap) < least:  # where a body is thin its other side faces, too, and is deeper
                least = abs(gap)
                best = e
            if kind == LINE:
                break
    if best >= 0:
        relative[FACING] = 1.0
        return _measure(numbers, relative, f, numbers[best + AT_X], numbers[best + AT_Y], numbers[best + RADIUS])
    at_end = _measure_end(numbers, relative, f, end - 1, U1X)
    if _measure_end(numbers, relative, f, first, U0X) < at_end:
        return _measure_end(numbers, relative, f, first, U0X)
    return _measure_end(numbers, relative, f, end - 1, U1X)


@internal
def _measure_end(numbers, relative, f, element, normal):
    """Return the gap of an element's end, whose unit normal is in the column ``normal``, from feature f."""
    e = _element_at(numbers, element)
    x = numbers[e + AT_X] + numbers[e + RADIUS] * numbers[e + normal]
    y = numbers[e + AT_Y] + numbers[e + RADIUS] * numbers[e + normal + 1]
    return _measure(numbers, relative, f, x, y, 0.0)


@internal
def _scale(numbers, f):
    """Return metres per unit of a feature's foot."""
    return 1.0 if numbers[f + KIND] == LINE else numbers[f + SIZE]


@internal
def _is_on(numbers, relative, feature):
    """Return True if the foot in the scratch is on a feature, or just beyond its concave corner."""
    f = feature_at(numbers, feature)
    count = int(numbers[FEATURES])
    before = numbers[feature_at(numbers, (feature + count - 1) % count) + LINKED]
    scale = _scale(numbers, f)
    span = numbers[f + SPAN]
    near = ROUNDING if numbers[f + KIND] != LINE else ROUNDING * span
    beyond = min(numbers[BEYOND] / scale, 0.5 * span) if scale > 0.0 else 0.0
    low = -near if before != 0.0 else -beyond
    high = span + near if numbers[f + LINKED] != 0.0 else span + beyond
    foot = relative[FOOT]
    if numbers[f + KIND] == CONCAVE and relative[CR] > numbers[f + SIZE]:
        return False
    return low <= foot and foot <= high


@internal
def _passes_corner(numbers, relative, run, feature, choice):
    """Return True if a corner or end in the scratch passes a corner of the outline without a touch.

    The feature's normal is then none of those there, so the bodies would overlap anywhere else on the feature.
    """
    row = run_at(numbers, run)
    if choice == FACES and not _is_corner(numbers, row):
        return False
    f = feature_at(numbers, feature)
    count = int(numbers[FEATURES])
    near = PASSING * numbers[f + SPAN]
    at_end = relative[FOOT] > numbers[f + SPAN] - near and _is_convex_corner(numbers, f, (feature + 1) % count)
    before = (feature + count - 1) % count
    at_begin = relative[FOOT] < near and _is_convex_corner(numbers, feature_at(numbers, before), before)
    if not (at_end or at_begin):
        return False
    dx = -numbers[f + T0Y]
    dy = numbers[f + T0X]
    if numbers[f + KIND] != LINE:
        dx = -numbers[f + KIND] * relative[WX]
        dy = -numbers[f + KIND] * relative[WY]
    c = math.cos(relative[A])
    s = math.sin(relative[A])
    return not _end_faces(numbers, row, choice, c * dx + s * dy, c * dy - s * dx)


@internal
def _end_faces(numbers, row, choice, dx, dy):
    """Return True if the normals at an end of a run include the direction (dx, dy) of marker j's axes."""
    first = int(numbers[row + FIRST])
    end = int(numbers[row + END])
    normal = U0X if choice == BEGIN else U1X
    for k in range(end - first):
        e = _element_at(numbers, first + k if choice == BEGIN else end - 1 - k)
        if numbers[e + RADIUS] > 0.0:
            off = numbers[e + normal] * dy - numbers[e + normal + 1] * dx
            ahead = numbers[e + normal] * dx + numbers[e + normal + 1] * dy
            return abs(off) <= ROUNDING * (abs(dx) + abs(dy)) and ahead > 0.0
        if _faces(numbers, e, dx, dy):
            return True
    return False


@internal
def _is_convex_corner(numbers, linked, feature):
    """Return True if a feature is a corner, and the one that stands at ``linked`` goes on to the next."""
    f = feature_at(numbers, feature)
    return numbers[linked + LINKED] != 0.0 and numbers[f + KIND] == CONVEX and numbers[f + SIZE] == 0.0


@internal
def touches(numbers, relative, feature):
    """Return True if the circle in the scratch may touch a feature: not left out, no two corners."""
    f = feature_at(numbers, feature)
    corners = numbers[f + KIND] == CONVEX and numbers[f + SIZE] == 0.0 and relative[CR] == 0.0
    return numbers[f + LEFT_OUT] == 0.0 and not corners


@internal
def _follow(numbers, relative, run, feature):
    """Go along the links to the feature that the foot is on; notes ROOM, returns feature and gap."""
    count = int(numbers[FEATURES])
    way = 0
    gap = 0.0
    relative[ROOM] = math.inf
    for _ in range(2 * count + 2):
        f = feature_at(numbers, feature)
        gap = stand(numbers, relative, run, f, FACES)
        foot = relative[FOOT]
        span = numbers[f + SPAN]
        radius = relative[CR]
        after = (feature + 1) % count
        before = (feature + count - 1) % count
        goes_on = numbers[f + LINKED] != 0.0
        came_from = numbers[feature_at(numbers, before) + LINKED] != 0.0
        room = math.inf
        scale = max(_scale(numbers, f), radius)
        if count > 1 and goes_on and foot > span and way >= 0 and _touches_next(numbers, relative, run, after):
            way = 1
            feature = after
            continue
        if count > 1 and came_from and foot < 0.0 and way <= 0 and _touches_next(numbers, relative, run, before):
            way = -1
            feature = before
            continue
        gap = stand(numbers, relative, run, f, FACES)
        if goes_on and not touches(numbers, relative, after):
            room = (span - foot) * scale
        if came_from and not touches(numbers, relative, before):
            room = min(room, foot * scale)
        if radius > 0.0 and numbers[f + KIND] == CONVEX and numbers[f + SIZE] == 0.0:
            room = min(room, _room_on_run(numbers, relative, run, f))
        relative[ROOM] = room
        break
    return feature, gap


@internal
def _touches_next(numbers, relative, run, feature):
    """Return True if a run may touch the feature beside its own, by the arc that faces that one."""
    stand(numbers, relative, run, feature_at(numbers, feature), FACES)
    return touches(numbers, relative, feature)


@internal
def _room_on_run(numbers, relative, run, f):
    """Return the way left (m) on an arc of a run, for a corner, up to where no other arc follows.

    Beyond is a corner, which meets a corner at no place, or a line, which is of another row.
    """
    row = run_at(numbers, run)
    first = int(numbers[row + FIRST])
    count = int(numbers[row + END]) - first
    closed = numbers[row + CLOSED] != 0.0
    c = math.cos(relative[A])
    s = math.sin(relative[A])
    wx = numbers[f + FEATURE_X] - relative[X]
    wy = numbers[f + FEATURE_Y] - relative[Y]
    room = math.inf
    for k in range(count):
        e = _element_at(numbers, first + k)
        dx = c * wx + s * wy - numbers[e + AT_X]
        dy = c * wy - s * wx - numbers[e + AT_Y]
        if numbers[e + RADIUS] == 0.0 or not _faces(numbers, e, dx, dy):
            continue
        turn = _turn(numbers, e, dx, dy)
        before = _element_at(numbers, first + (k + count - 1) % count)
        after = _element_at(numbers, first + (k + 1) % count)
        if (k == 0 and not closed) or numbers[before + RADIUS] == 0.0:
            room = min(room, numbers[e + RADIUS] * turn)
        if (k == count - 1 and not closed) or numbers[after + RADIUS] == 0.0:
            span = _turn(numbers, e, numbers[e + U1X], numbers[e + U1Y])
            room = min(room, numbers[e + RADIUS] * (span - turn))
    return room


@internal
def search(numbers, relative, first, end, skip_run, skip, skip_foot, within):
    """Return run, feature and gap of the nearest pair ``within`` (m), -1 without any.

    It is one of runs ``first`` to ``end``. Where run ``skip_run`` has a place on feature ``skip``, that is skipped.
    Circles around runs and features tell which pairs are farther apart, or deeper, than one that is known; the feature
    whose circle is nearest is looked at first.
    """
    count = int(numbers[FEATURES])
    c = math.cos(relative[A])
    s = math.sin(relative[A])
    best_run = -1
    best = -1
    end_used = FACES
    least = within
    for run in range(first, end):
        row = run_at(numbers, run)
        mx = relative[X] + c * numbers[row + RUN_X] - s * numbers[row + RUN_Y]
        my = relative[Y] + s * numbers[row + RUN_X] + c * numbers[row + RUN_Y]
        likely = -1
        nearest = math.inf
        for feature in range(count):
            away = _clear_of(numbers, feature_at(numbers, feature), row, mx, my)
            if away < nearest and not (run == skip_run and feature == skip):
                nearest = away
                likely = feature
        if nearest > abs(least) + numbers[MORE]:
            continue
        limit, _ = _pair_gap(numbers, relative, run, likely, skip_run, skip, skip_foot, least)
        for feature in range(count):
            near = abs(min(limit, least)) + numbers[MORE]
            if _clear_of(numbers, feature_at(numbers, feature), row, mx, my) > near:
                continue
            if run == skip_run and feature == skip:
                continue
            gap, choice = _pair_gap(numbers, relative, run, feature, skip_run, skip, skip_foot, least)
            if gap < least:
                least = gap
                best_run = run
                best = feature
                end_used = choice
    relative[USED_END] = end_used
    return best_run, best, least


@internal
def _clear_of(numbers, f, row, mx, my):
    """Return how far the circle around a run, about (mx, my), is from that around a feature (m)."""
    x = mx - numbers[f + CIRCLE_X]
    y = my - numbers[f + CIRCLE_Y]
    return math.sqrt(x * x + y * y) - numbers[row + RUN_REACH] - numbers[f + REACH]


@internal
def _pair_gap(numbers, relative, run, feature, skip_run, skip, skip_foot, least):
    """Return the gap of a run from a feature and what of the run is used; ``least`` where it is no less."""
    row = run_at(numbers, run)
    f = feature_at(numbers, feature)
    end_used = FACES
    for choice in range(1 if _is_corner(numbers, row) or numbers[row + CLOSED] != 0.0 else 3):
        gap = stand(numbers, relative, run, f, choice)
        if choice == FACES and relative[FACING] == 0.0:
            continue
        if gap <= -numbers[DEEPEST] or not _is_on(numbers, relative, feature):
            continue
        if _passes_corner(numbers, relative, run, feature, choice):
            continue
        side = APART
        if run == skip_run:
            side = _side_of(numbers, relative, feature, skip, skip_foot)
        if side != SAME and gap < least and (gap >= 0.0 or _is_in(numbers, relative, feature, gap)):
            least = gap
            end_used = choice
        if choice == FACES:
            break
    return least, end_used


@internal
def _side_of(numbers, relative, feature, skip, skip_foot):
    """Return how a feature goes on from the foot on ``skip``: the SAME place, or APART."""
    count = int(numbers[FEATURES])
    old = feature_at(numbers, skip)
    span = numbers[old + SPAN]
    near = NEAR_END * max(span, 1e-300)
    if feature == (skip + 1) % count:
        if numbers[old + LINKED] == 0.0:
            return APART
        if skip_foot > span - near:
            return SAME
    if feature == (skip + count - 1) % count:
        if numbers[feature_at(numbers, feature) + LINKED] == 0.0:
            return APART
        if skip_foot < near:
            return SAME
    return APART


@internal
def _is_in(numbers, relative, feature, gap):
    """Return True if the circle in the scratch enters the outline by a feature, from outside.

    Its point there is then inside, and no feature beyond the next ones is much nearer to it; or a corner is in it.
    """
    f = feature_at(numbers, feature)
    if numbers[f + KIND] == CONVEX and numbers[f + SIZE] == 0.0:
        return gap > -relative[CR]
    wx = relative[WX]
    wy = relative[WY]
    if numbers[f + KIND] == LINE:
        nx = numbers[f + T0Y]
        ny = -numbers[f + T0X]
    else:
        length = math.sqrt(wx * wx + wy * wy)
        if length == 0.0:
            return False
        nx = numbers[f + KIND] * wx / length
        ny = numbers[f + KIND] * wy / length
    x = relative[X] + relative[QX] - relative[CR] * nx
    y = relative[Y] + relative[QY] - relative[CR] * ny
    away, least = _distances(numbers, f, x, y)
    off = -least
    if away < math.inf and -gap <= least:
        least = -gap  # the same but for rounding, which must not change its sign
        off = gap
    count = int(numbers[FEATURES])
    for k in range(count):
        other = feature_at(numbers, k)
        dx = x - numbers[other + CIRCLE_X]
        dy = y - numbers[other + CIRCLE_Y]
        near = max(least, -0.5 * gap) + numbers[MORE]
        if k == feature or math.sqrt(dx * dx + dy * dy) - numbers[other + REACH] > near:
            continue
        away, corner = _distances(numbers, other, x, y)
        steps = abs(k - feature)
        if abs(away) < -0.5 * gap and min(steps, count - steps) > 2:
            return False
        if abs(away) < least:
            least = abs(away)
            off = away
        if corner < least:
            least = corner
            off = -corner
    return off < 0.0


@internal
def _distances(numbers, f, x, y):
    """Return how far a point is from a feature, and from a concave corner at its end, else infinity."""
    wx = x - numbers[f + FEATURE_X]
    wy = y - numbers[f + FEATURE_Y]
    size = numbers[f + SIZE]
    if numbers[f + KIND] == LINE:
        foot = numbers[f + T0X] * wx + numbers[f + T0Y] * wy
        off = numbers[f + T0Y] * wx - numbers[f + T0X] * wy
    else:
        turn = math.atan2(numbers[f + T0X] * wy - numbers[f + T0Y] * wx, numbers[f + T0X] * wx + numbers[f + T0Y] * wy)
        foot = numbers[f + KIND] * turn
        off = numbers[f + KIND] * (math.sqrt(wx * wx + wy * wy) - size)
    corner = math.inf
    if numbers[f + LINKED] == 0.0:
        corner = math.sqrt((wx - size * numbers[f + T1X]) ** 2 + (wy - size * numbers[f + T1Y]) ** 2)
    return (off if foot >= 0.0 and foot <= numbers[f + SPAN] else math.inf), corner


@internal
def find_pair(numbers, relative):
    """Return feature and gap of this row's pair, -1 where there is none; all else is left in the scratch."""
    codes = relative[LAST] if relative[LAST] == relative[LAST] else 0.0
    other = math.floor(codes / CODES)
    own = int(codes - CODES * other)
    if own > 0:
        run = (own - 1) // 4096
        feature, gap = _follow(numbers, relative, run, (own - 1) % 4096)
        relative[PLACE] = _code(run, feature)
        return feature, gap
    skip_run = -1
    skip = -1
    skip_foot = 0.0
    if other > 0:
        skip_run = (int(other) - 1) // 4096
        skip, _ = _follow(numbers, relative, skip_run, (int(other) - 1) % 4096)
        skip_foot = relative[FOOT]
    elif numbers[SECOND] != 0.0:
        skip_run, skip, _ = search(numbers, relative, 0, int(numbers[RUNS]), -1, -1, 0.0, numbers[NOWHERE])
        if skip >= 0:
            stand(numbers, relative, skip_run, feature_at(numbers, skip), int(relative[USED_END]))
            skip_foot = relative[FOOT]
    relative[ROOM] = math.inf
    relative[PLACE] = 0.0
    within = numbers[NOWHERE]
    run, feature, gap = search(numbers, relative, 0, int(numbers[RUNS]), skip_run, skip, skip_foot, within)
    if feature < 0:
        return -1, numbers[NOWHERE]
    gap = stand(numbers, relative, run, feature_at(numbers, feature), int(relative[USED_END]))
    if touches(numbers, relative, feature):
        relative[PLACE] = _code(run, feature)
    return feature, gap


@internal
def fill_gap(numbers, relative, out):
    """Fill out with the gap of this row (m) and its derivatives."""
    clear(out)
    feature, gap = find_pair(numbers, relative)
    out[F] = gap
    if feature < 0:
        return
    sign = 1.0
    if relative[PLACE] == 0.0:
        sign = 1.0 if gap >= 0.0 else -1.0
        out[F] = abs(gap) + numbers[MORE]
    f = feature_at(numbers, feature)
    if numbers[f + KIND] == LINE:
        _chain(relative, out, sign * numbers[f + T0Y], -sign * numbers[f + T0X], 0.0, 0.0, 0.0, 0.0)
        return
    wx = relative[WX]
    wy = relative[WY]
    length = math.sqrt(wx * wx + wy * wy)
    if length == 0.0:
        return
    gx = sign * numbers[f + KIND] * wx / length
    gy = sign * numbers[f + KIND] * wy / length
    bend = sign * numbers[f + KIND] / (length * length * length)
    _chain(relative, out, gx, gy, 0.0, bend * wy * wy, -bend * wx * wy, bend * wx * wx)


@internal
def fill_slid(numbers, relative, out):
    """Fill out with how far the two have slid at this row's pair (m)."""
    clear(out)
    feature, _ = find_pair(numbers, relative)
    if feature < 0:
        return
    f = feature_at(numbers, feature)
    kind = numbers[f + KIND]
    r = relative[CR]
    foot = relative[FOOT]
    value = numbers[f + ARC] + foot * _scale(numbers, f)
    phi = numbers[f + PHI]
    if kind != LINE:
        phi += kind * foot
    run = (int(relative[PLACE]) - 1) // 4096 if relative[PLACE] > 0.0 else -1
    if run >= 0:
        value += _run_slid(numbers, relative, run, phi)
    out[F] = value
    if kind == LINE:
        _chain(relative, out, numbers[f + T0X], numbers[f + T0Y], -r, 0.0, 0.0, 0.0)
        return
    wx = relative[WX]
    wy = relative[WY]
    square = wx * wx + wy * wy
    if square == 0.0:
        return
    around = kind * numbers[f + SIZE] + r
    bend = around / (square * square)
    _chain(
        relative, out, -around * wy / square, around * wx / square, -r, 2.0 * bend * wx * wy,
        bend * (wy * wy - wx * wx), -2.0 * bend * wx * wy,
    )  # fmt: skip


@internal
def _run_slid(numbers, relative, run, phi):
    """Return the length along a run up to where its normal has the angle phi (rad) in the axes of i."""
    row = run_at(numbers, run)
    first = int(numbers[row + FIRST])
    end = int(numbers[row + END])
    e = _element_at(numbers, first)
    angle = phi - relative[A]
    dx = math.cos(angle)
    dy = math.sin(angle)
    if relative[CR] == 0.0:  # a corner, or an end: it does not roll
        best = 0.0
        least = math.inf
        for k in range(first, end + 1):
            last = min(k, end - 1)
            e = _element_at(numbers, last)
            normal_x = numbers[e + U0X] if k < end else numbers[e + U1X]
            normal_y = numbers[e + U0Y] if k < end else numbers[e + U1Y]
            c = math.cos(relative[A])
            s = math.sin(relative[A])
            px = numbers[e + AT_X] + numbers[e + RADIUS] * normal_x
            py = numbers[e + AT_Y] + numbers[e + RADIUS] * normal_y
            off = abs(c * px - s * py - relative[QX]) + abs(s * px + c * py - relative[QY])
            if off < least:
                least = off
                best = numbers[e + LENGTH]
                if k == end:
                    best += numbers[e + RADIUS] * _turn(numbers, e, normal_x, normal_y)
        return best
    for k in range(first, end):
        e = _element_at(numbers, k)
        if _faces(numbers, e, dx, dy):
            break
    turn = _turn(numbers, e, dx, dy)
    value = numbers[e + LENGTH] + numbers[e + RADIUS] * turn
    if numbers[row + CLOSED] != 0.0:
        value += numbers[row + RUN_LENGTH] * math.floor((angle - numbers[e + ANGLE] - turn) / (2.0 * math.pi) + 0.5)
    return value


@internal
def _turn(numbers, e, dx, dy):
    """Return the angle (rad) from an element's first normal to the direction (dx, dy)."""
    return math.atan2(numbers[e + U0X] * dy - numbers[e + U0Y] * dx, numbers[e + U0X] * dx + numbers[e + U0Y] * dy)


@internal
def _chain(relative, out, gx, gy, ga, gxx, gxy, gyy):
    """Fill the derivatives of a function of the circle's centre, c = (x, y) + q(a), and of a."""
    qx = relative[QX]
    qy = relative[QY]
    out[FX] = gx
    out[FY] = gy
    out[FA] = gy * qx - gx * qy + ga
    out[FXX] = gxx
    out[FXY] = gxy
    out[FYY] = gyy
    out[FXA] = gxy * qx - gxx * qy
    out[FYA] = gyy * qx - gxy * qy
    out[FAA] = gxx * qy * qy - 2.0 * gxy * qx * qy + gyy * qx * qx - gx * qx - gy * qy
