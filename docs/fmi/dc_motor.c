/* A DC motor as a co-simulation unit (FMI 3.0), to be coupled to a mechanism that mbsd exported.

       L di/dt = voltage - R i - k speed,    torque = k i

   It is integrated exactly over a step, in which voltage and speed stay as they are. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { TIME, VOLTAGE, SPEED, CURRENT, TORQUE, RESISTANCE, INDUCTANCE, CONSTANT, VARIABLES };
static const double START[VARIABLES] = {0.0, 12.0, 0.0, 0.0, 0.0, 2.0, 4e-3, 0.05};

typedef struct {
    double of[VARIABLES];
} Motor;

const char *fmi3GetVersion(void) { return "3.0"; }

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                  bool event_mode, bool early, const uint32_t *intermediate, size_t count,
                                  void *environment, void *log, void *update) {
    (void)name, (void)resources, (void)visible, (void)logging, (void)event_mode, (void)early, (void)intermediate;
    (void)count, (void)environment, (void)log, (void)update;
    if (strcmp(token, "{dc-motor-1}") != 0) return NULL;
    Motor *motor = malloc(sizeof *motor);
    if (motor) memcpy(motor->of, START, sizeof START);
    return motor;
}

void fmi3FreeInstance(void *motor) { free(motor); }

int fmi3EnterInitializationMode(void *motor, bool tolerant, double tolerance, double start, bool stops, double stop) {
    (void)tolerant, (void)tolerance, (void)stops, (void)stop;
    ((Motor *)motor)->of[TIME] = start;
    return 0;
}

int fmi3ExitInitializationMode(void *motor) {
    (void)motor;
    return 0;
}

int fmi3Terminate(void *motor) {
    (void)motor;
    return 0;
}

int fmi3GetFloat64(void *motor, const uint32_t of[], size_t count, double values[], size_t room) {
    for (size_t k = 0; k < count && k < room; k++) {
        if (of[k] >= VARIABLES) return 3;
        values[k] = ((Motor *)motor)->of[of[k]];
    }
    return 0;
}

int fmi3SetFloat64(void *motor, const uint32_t of[], size_t count, const double values[], size_t room) {
    for (size_t k = 0; k < count && k < room; k++) {
        if (of[k] == TIME || of[k] >= VARIABLES) return 3;
        ((Motor *)motor)->of[of[k]] = values[k];
    }
    return 0;
}

int fmi3DoStep(void *motor, double now, double step, bool no_way_back, bool *event, bool *terminate, bool *early,
               double *last) {
    double *it = ((Motor *)motor)->of;
    (void)no_way_back;
    double settled = (it[VOLTAGE] - it[CONSTANT] * it[SPEED]) / it[RESISTANCE];
    it[CURRENT] = settled + (it[CURRENT] - settled) * exp(-step * it[RESISTANCE] / it[INDUCTANCE]);
    it[TORQUE] = it[CONSTANT] * it[CURRENT];
    it[TIME] = *last = now + step;
    *event = *terminate = *early = false;
    return 0;
}

/* Importers look for all functions of the standard; these have nothing to do here. */
#define ABSENT(name) \
    int fmi3##name(void) { return 3; }
ABSENT(SetDebugLogging) ABSENT(InstantiateModelExchange) ABSENT(InstantiateScheduledExecution) ABSENT(EnterEventMode)
ABSENT(Reset) ABSENT(GetFloat32) ABSENT(GetInt8) ABSENT(GetUInt8) ABSENT(GetInt16) ABSENT(GetUInt16) ABSENT(GetInt32)
ABSENT(GetUInt32) ABSENT(GetInt64) ABSENT(GetUInt64) ABSENT(GetBoolean) ABSENT(GetString) ABSENT(GetBinary)
ABSENT(GetClock) ABSENT(SetFloat32) ABSENT(SetInt8) ABSENT(SetUInt8) ABSENT(SetInt16) ABSENT(SetUInt16)
ABSENT(SetInt32) ABSENT(SetUInt32) ABSENT(SetInt64) ABSENT(SetUInt64) ABSENT(SetBoolean) ABSENT(SetString)
ABSENT(SetBinary) ABSENT(SetClock) ABSENT(GetNumberOfVariableDependencies) ABSENT(GetVariableDependencies)
ABSENT(GetFMUState) ABSENT(SetFMUState) ABSENT(FreeFMUState) ABSENT(SerializedFMUStateSize) ABSENT(SerializeFMUState)
ABSENT(DeserializeFMUState) ABSENT(GetDirectionalDerivative) ABSENT(GetAdjointDerivative)
ABSENT(EnterConfigurationMode) ABSENT(ExitConfigurationMode) ABSENT(GetIntervalDecimal) ABSENT(GetIntervalFraction)
ABSENT(GetShiftDecimal) ABSENT(GetShiftFraction) ABSENT(SetIntervalDecimal) ABSENT(SetIntervalFraction)
ABSENT(SetShiftDecimal) ABSENT(SetShiftFraction) ABSENT(EvaluateDiscreteStates) ABSENT(UpdateDiscreteStates)
ABSENT(EnterContinuousTimeMode) ABSENT(CompletedIntegratorStep) ABSENT(SetTime) ABSENT(SetContinuousStates)
ABSENT(GetContinuousStateDerivatives) ABSENT(GetEventIndicators) ABSENT(GetContinuousStates)
ABSENT(GetNominalsOfContinuousStates) ABSENT(GetNumberOfEventIndicators) ABSENT(GetNumberOfContinuousStates)
ABSENT(EnterStepMode) ABSENT(GetOutputDerivatives) ABSENT(ActivateModelPartition)
