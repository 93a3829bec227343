/* Co-simulation: the unit goes on by itself, with the integrator of the solver. */
#include <math.h>
#include <string.h>

#include "instance.h"

extern Kernel *const mbsd_advance;

EXPORT Status fmi3EnterStepMode(void *instance) {
    ((Instance *)instance)->kept.mode = STEPPING;
    return OK;
}

/* Inputs that have changed: speeds fit the drivers' rates again, and the next step begins with new derivatives. */
static Status take_inputs(Instance *it) {
    double moved;
    if (!it->kept.changed) return OK;
    if (it->kept.jumped) {
        Status status = project_state(it, 2, &moved);
        if (status != OK) return status;
    }
    it->kept.changed = it->kept.jumped = false;
    integers(it, AT_COUNT)[STARTED] = 0;
    numbers(it, AT_CLOCK)[LAST_ERROR] = 0.0;
    return OK;
}

/* Bits of the contacts that touch; they are tables of SWITCH_WIDTH numbers, the depth in column 1. */
static uint64_t touching(Instance *it) {
    uint64_t out = 0;
    for (int k = 1; k < SWITCHES; k++)
        if (numbers(it, AT_SWITCH)[SWITCH_WIDTH * k + 1] > 0.0) out |= 1ull << (k % 64);
    return out;
}

static Status refuse(Instance *it, int64_t why) {
    return say(it, ERROR, "t = %.9g s: %s", numbers(it, AT_CLOCK)[TIME],
               why == STEP_TOO_SMALL ? "steps become too short: a force jumps, or is far too stiff"
                                     : "accelerations are not finite, or links no longer close");
}

/* From stop to stop of the laws to the end; where contacts may return early, one step at a time. */
static Status go_on(Instance *it, double end, bool *early) {
    double *clock = numbers(it, AT_CLOCK);
    int64_t *count = integers(it, AT_COUNT);
    while (clock[TIME] < end) {
        int k = 0;
        while (k < STOPS && STOP_BEFORE[k] < clock[TIME]) k++;
        if (k < STOPS && STOP_BEFORE[k] == clock[TIME]) { /* the step after a stop begins behind it */
            if (STOP_AFTER[k] > clock[TIME]) clock[TIME] = STOP_AFTER[k], clock[STEP] = 0.0, count[STARTED] = 0;
            k++;
        }
        double target = k < STOPS && STOP_BEFORE[k] < end ? STOP_BEFORE[k] : end;
        int64_t result = 0;
        void *error = NULL;
        uint64_t before = touching(it);
        bool watch = it->early && SWITCHES > 1;
        memcpy(&it->advance[ADVANCE_END], &target, sizeof target);
        it->advance[ADVANCE_STEPS] = watch ? 1 : INT64_C(1000000000);
        if (mbsd_advance(&result, &error, it->advance) != 0 || (result != REACHED && result != PAUSED))
            return refuse(it, result);
        if (watch && touching(it) != before && clock[TIME] < end) {
            *early = true;
            return OK;
        }
    }
    return OK;
}

EXPORT Status fmi3DoStep(void *instance, double now, double step, bool no_way_back, bool *event, bool *terminate,
                         bool *early, double *last) {
    Instance *it = instance;
    (void)no_way_back;
    *event = *terminate = *early = false;
    *last = it->kept.time;
    if (!(step > 0.0)) return say(it, ERROR, "the step %g s is not positive", step);
    if (fabs(now - it->kept.time) > 1e-9 * (step + fabs(now)))
        return say(it, ERROR, "a step from t = %.9g s is asked for, and the unit is at %.9g s", now, it->kept.time);
    Status status = take_inputs(it);
    if (status == OK) status = go_on(it, now + step, early);
    it->kept.time = *early ? numbers(it, AT_CLOCK)[TIME] : now + step;
    it->kept.rates_valid = it->kept.rows_valid = false;
    if (status == OK) *last = it->kept.time;
    return status;
}
