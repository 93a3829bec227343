/* Functions that an importer may look for and this unit has no use for: other types, clocks, derivatives of outputs.
   They refuse, as the standard asks. */
#include "instance.h"

#define REFUSE(what) return say(instance, ERROR, what)
#define GET(type, c_type)                                                                                            \
    EXPORT Status fmi3Get##type(void *instance, const Reference of[], size_t count, c_type values[], size_t room) {  \
        (void)of, (void)values, (void)room;                                                                          \
        if (count == 0) return OK;                                                                                   \
        REFUSE("it has no variables of type " #type);                                                                \
    }
#define SET(type, c_type)                                                                                            \
    EXPORT Status fmi3Set##type(void *instance, const Reference of[], size_t count, const c_type values[],           \
                                size_t room) {                                                                       \
        (void)of, (void)values, (void)room;                                                                          \
        if (count == 0) return OK;                                                                                   \
        REFUSE("it has no variables of type " #type);                                                                \
    }
#define BOTH(type, c_type) GET(type, c_type) SET(type, c_type)

BOTH(Float32, float)
BOTH(Int8, int8_t)
BOTH(UInt8, uint8_t)
BOTH(Int16, int16_t)
BOTH(UInt16, uint16_t)
BOTH(Int32, int32_t)
BOTH(UInt32, uint32_t)
BOTH(Int64, int64_t)
BOTH(UInt64, uint64_t)
BOTH(Boolean, bool)
BOTH(String, Text)

#define NONE(name, words, ...)                                                                                       \
    EXPORT Status name(void *instance, __VA_ARGS__) { REFUSE(words); }
#define UNUSED __attribute__((unused))
#define REFS UNUSED const Reference of[], UNUSED size_t count

NONE(fmi3GetBinary, "it has no binary variables", REFS, UNUSED size_t sizes[], UNUSED const uint8_t *values[],
     UNUSED size_t room)
NONE(fmi3SetBinary, "it has no binary variables", REFS, UNUSED const size_t sizes[],
     UNUSED const uint8_t *const values[], UNUSED size_t room)
NONE(fmi3GetClock, "it has no clocks", REFS, UNUSED bool values[])
NONE(fmi3SetClock, "it has no clocks", REFS, UNUSED const bool values[])
NONE(fmi3GetIntervalDecimal, "it has no clocks", REFS, UNUSED double intervals[], UNUSED int qualifiers[])
NONE(fmi3GetIntervalFraction, "it has no clocks", REFS, UNUSED uint64_t counters[], UNUSED uint64_t resolutions[],
     UNUSED int qualifiers[])
NONE(fmi3GetShiftDecimal, "it has no clocks", REFS, UNUSED double shifts[])
NONE(fmi3GetShiftFraction, "it has no clocks", REFS, UNUSED uint64_t counters[], UNUSED uint64_t resolutions[])
NONE(fmi3SetIntervalDecimal, "it has no clocks", REFS, UNUSED const double intervals[])
NONE(fmi3SetIntervalFraction, "it has no clocks", REFS, UNUSED const uint64_t counters[],
     UNUSED const uint64_t resolutions[])
NONE(fmi3SetShiftDecimal, "it has no clocks", REFS, UNUSED const double shifts[])
NONE(fmi3SetShiftFraction, "it has no clocks", REFS, UNUSED const uint64_t counters[],
     UNUSED const uint64_t resolutions[])
NONE(fmi3GetNumberOfVariableDependencies, "dependencies are not given", UNUSED Reference of, UNUSED size_t *count)
NONE(fmi3GetVariableDependencies, "dependencies are not given", UNUSED Reference of, UNUSED size_t elements[],
     UNUSED Reference independents[], UNUSED size_t others[], UNUSED int kinds[], UNUSED size_t count)
NONE(fmi3GetDirectionalDerivative, "it has no directional derivatives", REFS, UNUSED const Reference knowns[],
     UNUSED size_t known, UNUSED const double seed[], UNUSED size_t seeds, UNUSED double out[], UNUSED size_t room)
NONE(fmi3GetAdjointDerivative, "it has no adjoint derivatives", REFS, UNUSED const Reference knowns[],
     UNUSED size_t known, UNUSED const double seed[], UNUSED size_t seeds, UNUSED double out[], UNUSED size_t room)
NONE(fmi3GetOutputDerivatives, "it has no derivatives of outputs", REFS, UNUSED const int32_t orders[],
     UNUSED double values[], UNUSED size_t room)
NONE(fmi3ActivateModelPartition, "it has no clocks", UNUSED Reference clock, UNUSED double time)

EXPORT Status fmi3EnterConfigurationMode(void *instance) { REFUSE("it has no structural parameters"); }
EXPORT Status fmi3ExitConfigurationMode(void *instance) { REFUSE("it has no structural parameters"); }
EXPORT Status fmi3EvaluateDiscreteStates(void *instance) {
    (void)instance;
    return OK;
}

EXPORT void *fmi3InstantiateScheduledExecution(Text name, Text token, Text resources, bool visible, bool logging,
                                               void *environment, Log log, void (*clock_update)(void *),
                                               void (*lock)(void), void (*unlock)(void)) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)clock_update, (void)lock;
    (void)unlock;
    if (log) log(environment, ERROR, "logStatusError", MODEL_NAME ": it has no scheduled execution");
    return NULL;
}
