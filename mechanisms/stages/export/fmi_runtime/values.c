/* Variables by their value references: 0 is the time, the others are those of model.h in order, from 1. */
#include <math.h>

#include "instance.h"

static Status get(Instance *it, const Variable *of, double *out) {
    Status status = of->kind == JOINT ? rows(it) : evaluate(it);
    if (status != OK) return status;
    double several[9];
    switch (of->kind) {
    case FRAME:
        frame(it, of->index, several);
        *out = several[of->component];
        break;
    case JOINT:
        reaction(it, of->index, several);
        *out = several[of->component];
        break;
    case DRIVER:
        *out = of->component < 3 ? numbers(it, AT_DRIVE)[3 * (of->index + 1) + of->component]
                                 : -numbers(it, AT_LAM)[DRIVER_ROWS + of->index];
        break;
    case ENERGY: *out = energy(it, of->component); break;
    case MASS: *out = numbers(it, AT_INERTIA)[3 * of->index]; break;
    case INERTIA: *out = numbers(it, AT_INERTIA)[3 * of->index + 2]; break;
    case GRAVITY: *out = numbers(it, AT_GRAVITY)[of->component]; break;
    case RATE: *out = numbers(it, of->place)[1]; break;
    default: *out = *numbers(it, of->place);
    }
    return OK;
}

EXPORT Status fmi3GetFloat64(void *instance, const Reference of[], size_t count, double values[], size_t room) {
    Instance *it = instance;
    if (count != room) return say(it, ERROR, "%zu variables are asked for and %zu values given", count, room);
    for (size_t k = 0; k < count; k++) {
        Status status = OK;
        if (of[k] > VARIABLES) return say(it, ERROR, "there is no variable %u; the last is %d", of[k], VARIABLES);
        if (of[k] == 0)
            values[k] = it->kept.time;
        else
            status = get(it, &VARIABLE[of[k] - 1], &values[k]);
        if (status != OK) return status;
    }
    return OK;
}

static Status set(Instance *it, Reference which, double value) {
    if (which == 0 || which > VARIABLES) return say(it, ERROR, "variable %u cannot be set", which);
    const Variable *of = &VARIABLE[which - 1];
    bool state = which <= STATES, input = which > STATES && which <= STATES + INPUTS;
    bool parameter = which > STATES + INPUTS && which <= STATES + INPUTS + PARAMETERS;
    bool before = it->kept.mode == INSTANTIATED || it->kept.mode == INITIALIZATION;
    if (!isfinite(value)) return say(it, ERROR, "%s: %g is no number", NAME[which - 1], value);
    if (!input && !(before && (state || parameter)))
        return say(it, ERROR, "%s is no input: it can be set before the start alone, if at all", NAME[which - 1]);
    if ((of->kind == MASS || of->kind == INERTIA) && !(value > 0.0))
        return say(it, ERROR, "%s is %g; it must be positive", NAME[which - 1], value);
    switch (of->kind) {
    case MASS: set_mass(it, of->index, value); break;
    case INERTIA: set_inertia(it, of->index, value); break;
    case GRAVITY: set_gravity(it, of->component, value); break;
    case RATE:
        if (value == numbers(it, of->place)[1]) return OK;
        if (it->kept.mode == CONTINUOUS) return say(it, ERROR, "%s changes at events alone", NAME[which - 1]);
        set_rate(it, of->index, of->place, value);
        it->kept.jumped = true;
        break;
    default:
        if (*numbers(it, of->place) == value) return OK;
        *numbers(it, of->place) = value;
    }
    it->kept.changed = true;
    it->kept.rates_valid = it->kept.rows_valid = false;
    return OK;
}

EXPORT Status fmi3SetFloat64(void *instance, const Reference of[], size_t count, const double values[], size_t room) {
    Instance *it = instance;
    if (count != room) return say(it, ERROR, "%zu variables are set and %zu values given", count, room);
    for (size_t k = 0; k < count; k++) {
        Status status = set(it, of[k], values[k]);
        if (status != OK) return status;
    }
    return OK;
}
