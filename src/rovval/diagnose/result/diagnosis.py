"""The typed answer of a diagnosis, frozen; the JSON document (schema rovval.diagnosis/1) is one way to write it.

Every field says its meaning and unit; `docs/schemas/diagnosis.json` is made of these types. Shares are of squared errors and
without unit; intervals are 90 %; times are seconds since the run's start. Words that a person reads (``answer``, ``sentence``,
``Unexplained.text``, ``Recalibration.command``) are empty until `rovval.report` writes them.

A key of the document that is not the field's term stays beside it for programs that read it: ``beside_slop`` is
``within_tolerance``, ``slop`` is ``tolerance_share``, ``strain`` is ``largest_departure``, ``tolerances`` is ``departure``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, Literal, Self

from pydantic import AliasChoices, BaseModel, ConfigDict, Field, ValidationError, computed_field
from pydantic.json_schema import GenerateJsonSchema, SkipJsonSchema

from rovval.core.errors import BadInput, all_at_once
from rovval.diagnose.decision.indications import Lack, indications
from rovval.diagnose.decision.unexplained import Accounted
from rovval.diagnose.decision.verdict import Verdict
from rovval.diagnose.residuals.sensor_faults import FittedFault

SCHEMA: Final = "rovval.diagnosis/1"


class Record(BaseModel):
    """A part of a diagnosis: frozen; keys that it does not know, of later versions, are passed over when it is read."""

    model_config = ConfigDict(
        frozen=True, extra="ignore", populate_by_name=True, json_schema_serialization_defaults_required=True
    )


class _Untitled(GenerateJsonSchema):
    """A schema without titles that only repeat a key."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


class AxisGap(Record):
    """How far the nominal simulator is from the vehicle on one axis, in windows restarted from the measured state."""

    unit: str = Field(description="unit of rms and floor_rms: m/s, rad/s; m or rad where no velocity was logged")
    channel: str = Field(default="", description="measured channel that the simulation is held against, such as u")
    rms: float = Field(description="root mean square error, in unit")
    iae: float = Field(description="integral over time of the absolute error, in unit times seconds")
    floor_rms: float = Field(description="noise of the sensor, rms in unit: no simulator comes nearer")
    share: float = Field(description="share of the whole squared gap, axes weighted by their residual covariance")
    calibrated_rms: float | None = Field(
        default=None, description="root mean square error that the vehicle's calibration left of its own logs, in unit; null without `rovval fit`"
    )


class GapSlice(Record):
    """One axis in one regime that holds more of the axis's squared gap than its part of the time."""

    axis: str = Field(description="surge, sway, heave, roll, pitch or yaw")
    regime: str = Field(description="when: a level of speed, turn rate, depth, altitude, heading or thruster, such as 'u > 0.6 m/s'")
    share: float = Field(description="share of the axis's squared gap")
    time_share: float = Field(description="share of the time")
    lift: float = Field(description="share over time_share")
    low: float | None = Field(default=None, description="lower end of lift's interval")
    high: float | None = Field(default=None, description="upper end of lift's interval")


class Gap(Record):
    """The gap between the nominal simulator and the vehicle: its size, where it lies, when it changes."""

    axes: Mapping[str, AxisGap] = Field(description="by axis, those that were measured")
    where: tuple[GapSlice, ...] = Field(description="regimes that hold most of the gap in little of the time, the worst first")
    change_points_s: tuple[float, ...] = Field(description="times at which the mean residual changes level, s")

    @property
    def calibrated(self) -> bool:
        """Whether it is known what the vehicle's calibration left on some axis."""
        return any(row.calibrated_rms is not None for row in self.axes.values())


class Interval(Record):
    """A 90 % interval."""

    low: float = Field(description="lower end")
    high: float = Field(description="upper end")


class Reduction(Interval):
    """Relative reduction of a squared prediction error, with its interval."""

    total: float = Field(description="1 - error after / error before; negative where it grew")


class Shrinkage(Reduction):
    """How far the squared gap shrinks with effects added to the nominal simulator, on data that they were not fitted to."""

    of_explainable: float = Field(description="the same as a share of what lies above the noise of the sensors, 1 at most")
    axes: Mapping[str, float] = Field(default_factory=dict, description="total by axis; empty where nothing was added")
    axes_interval: Mapping[str, Interval] = Field(default_factory=dict, description="its interval by axis")
    held_out: bool = Field(default=True, description="whether it was scored on data left out of the fit")


class RunValue(Interval):
    """A parameter of a cause as one of several runs has it."""

    value: float = Field(description="estimate, in the parameter's unit")


class Parameter(Interval):
    """A parameter of a cause, from the joint fit of all causes."""

    value: float = Field(description="estimate, in unit")
    unit: str = Field(description="unit of value, low, high and null; 1 for a ratio")
    null: float | None = Field(default=None, description="value at which the effect changes nothing")
    at_bound: bool = Field(default=False, description="whether the fit rests at a bound of the parameter")
    by_run: Mapping[str, RunValue] = Field(
        default_factory=dict, description="what each of several runs says of it, the vehicle's file as all of them have it; runs that say something"
    )
    homogeneity: float | None = Field(
        default=None, description="probability that runs which share one value differ by as much (Cochran 1954); null where fewer than two say something"
    )


class Correlation(Record):
    """Two parameters of a cause that the log hardly tells apart: at 1 or -1 it shows one combination of them only."""

    of: tuple[str, str] = Field(description="the two parameters")
    value: float = Field(description="their correlation in the joint fit")


class Cause(Record):
    """An isolated cause: an effect of the library that the gap is put down to."""

    effect: str = Field(description="name in the library, with its axis or thruster: thruster_degraded[HFP]")
    title: str = Field(default="", description="the effect in a few words")
    group: tuple[str, ...] = Field(description="confusion group: what this log cannot tell apart, the cause itself first")
    kind: Literal["effect", "file"] = Field(
        default="effect", description="file: a number of the vehicle's file that is off; effect: something that the simulator lacks"
    )
    probability: float = Field(description="probability that it is at work")
    onset_s: float | None = Field(description="time from which it is at work, s; null: all of the log")
    parameters: Mapping[str, Parameter] = Field(description="by name")
    together: tuple[Correlation, ...] = Field(default=(), description="pairs of parameters that the log shows together only, the closest first")
    evidence: float | None = Field(default=None, description="twice the log Bayes factor of the model with it over that without it")
    shrinkage: Shrinkage = Field(description="by itself, without the other causes")


class Score(Record):
    """An effect in the screening of the library."""

    effect: str = Field(description="name in the library")
    score: float = Field(description="share of the squared gap that it takes away on held-out windows, linearised")


class NotTestable(Record):
    """An effect that these logs could not show."""

    effect: str = Field(description="name in the library")
    why: str = Field(description="what is missing: a channel, an excitation")


class Candidate(Record):
    """A cause that was fitted by re-simulation in one step of the forward selection."""

    effect: str = Field(description="name in the library")
    evidence: float = Field(description="twice the log Bayes factor over the model of that step without it")
    gain: float = Field(description="share of the squared gap that it takes away on held-out windows")


class Probabilities(Record):
    """How probable each kind of model is; the five sum to one."""

    healthy: float = Field(description="a vehicle as its file has it, within tolerance")
    causes: float = Field(description="causes of the library, alone or with something else beside them")
    miscalibrated_file: float = Field(description="a file that is off in many numbers at once")
    something_else: float = Field(description="something that the library does not hold")
    not_found: float = Field(
        default=0.0, description="an effect of the library that no fit explains the log with: the search did not come near it, or its equations are others here"
    )


class UnloggedForce(Record):
    """The force that nobody logged, as large as is most likely for what a model leaves, where that acts: as a share of the rms force of all thrusters."""

    size: float = Field(description="its standard deviation, 1 is the thrusters' own")
    expected: float = Field(description="its median beside causes that are right, the same unit")
    alike: float | None = Field(default=None, description="its median beside what only looks like causes, the same unit; null in older documents")
    evidence: float = Field(description="twice the log Bayes factor of something that only looks like the causes over these, by its size")


class Detection(Record):
    """What the verdict rests on."""

    noise: float = Field(description="share of the gap that is noise of the sensors")
    tolerance_share: float = Field(
        validation_alias=AliasChoices("tolerance_share", "slop"),
        description="share of the gap that coefficients within their tolerances take away without any cause",
    )
    causes: float = Field(description="twice the log Bayes factor of the causes, named or rejected, over the healthy vehicle")
    generic_instead: float = Field(description="the same of generic forces in the place of the causes")
    generic_beside: float = Field(description="twice the log Bayes factor of generic forces beside the causes over the causes")
    largest_departure: float = Field(
        validation_alias=AliasChoices("largest_departure", "strain"),
        description="largest standardised departure of a coefficient that is no cause's, in standard deviations of its prior",
    )
    open_gap: float = Field(
        default=0.0,
        description="squared gap that causes, or where none are named any model, leave beyond noise, over what noise and tolerances are expected to make",
    )

    unlogged_force: UnloggedForce | None = Field(
        default=None, description="the force that nobody logged where the most probable causes act, named or rejected; null where it is not known"
    )

    calibration_left: float = Field(
        default=0.0,
        description="squared gap that the calibration of the vehicle left of its own logs, over that of this one; 0 without `rovval fit`",
    )

    @computed_field(description="older key of tolerance_share")  # type: ignore[prop-decorator]
    @property
    def slop(self) -> float:
        """Older key of tolerance_share."""
        return self.tolerance_share

    @computed_field(description="older key of largest_departure")  # type: ignore[prop-decorator]
    @property
    def strain(self) -> float:
        """Older key of largest_departure."""
        return self.largest_departure


class Disturbance(Record):
    """A force that nobody logged, on one axis: an Ornstein-Uhlenbeck process that every fit allows for."""

    rms: float = Field(description="its rms, in unit")
    unit: str = Field(description="N or N m")
    memory_s: float = Field(description="its correlation time, s")


class Departure(Record):
    """A coefficient of the vehicle's file that is off."""

    coefficient: str = Field(description="name, as thruster_degraded[HFP].loss")
    departure: float = Field(description="standardised departure, in standard deviations of its prior")


class Dependence(Record):
    """A size that changes with something that was logged."""

    effect: str = Field(description="name of the effect of which it is the size")
    covariate: str = Field(description="what it changes with")


class Oscillation(Record):
    """A narrow band of periods."""

    period_s: float = Field(description="its middle, s")
    share: float = Field(description="its share of the squared residual velocities")


class Unexplained(Record):
    """What the causes leave unexplained; all of the gap where none is named."""

    axes: tuple[str, ...] = Field(description="axes that something acts on, the first most")
    depends_on: tuple[str, ...] = Field(description="what it varies with, the strongest first")
    share: float = Field(default=0.0, description="share of what is left that generic forces take away on held-out windows")
    departed: Departure | None = Field(default=None, description="coefficient furthest beyond its tolerance, where one is")
    inconstant: tuple[str, ...] = Field(default=(), description="effects that come near, but whose value would change along the log")
    goes_with: Dependence | None = Field(default=None, description="cause, or what comes near to one, of which the size changes with something that was logged")
    oscillation: Oscillation | None = Field(default=None, description="the narrow band of periods in which most of it comes and goes, as in a seaway")
    accounted: float | None = Field(
        default=None,
        description="share of the gap, or of what causes leave of it, that noise and tolerance account for, where that is so little that it stays open; "
        "null where a force, a coefficient or an effect is surely at work",
    )
    text: str = Field(default="", description="the same in words")


class Coefficient(Interval):
    """A parameter of a joint recalibration."""

    value: float = Field(description="estimate, in unit")
    unit: str = Field(description="unit of value, low, high, was and tolerance; 1 for a ratio")
    was: float = Field(description="what the vehicle's file says")
    tolerance: float | None = Field(description="standard deviation of its prior about the file's value; null: none is stated")
    departure: float | None = Field(
        validation_alias=AliasChoices("departure", "tolerances"), description="standardised departure: (value - was) / tolerance"
    )
    beyond: bool = Field(description="whether all of its interval is beyond the tolerance")
    at_bound: bool = Field(description="whether the fit rests at a bound of the parameter")
    of_cause: bool = Field(description="whether it is a named cause's, and no matter of the file")

    @computed_field(description="older key of departure")  # type: ignore[prop-decorator]
    @property
    def tolerances(self) -> float | None:
        """Older key of departure."""
        return self.departure


class AxisHarm(Record):
    """An axis on which the simulator gets worse with the effects added."""

    axis: str = Field(description="surge, sway, heave, roll, pitch or yaw")
    change: float = Field(description="relative growth of its squared error")


class Recalibration(Record):
    """Many coefficients of the vehicle's file that are off at once, tuned jointly with the named causes. It is not a cause."""

    parameters: Mapping[str, Coefficient] = Field(description="by name, the largest departure first, those of causes last")
    beyond: tuple[str, ...] = Field(description="those beyond their tolerance, in the same order")
    shrinkage: Shrinkage = Field(description="of the squared gap with all of them, on data left out of the fit")
    held_out: Literal["runs", "windows"] = Field(description="what was left out of the fit")
    harm: tuple[AxisHarm, ...] = Field(description="axes that get worse")
    fitted: tuple[str, ...] = Field(default=(), description="parameters that `rovval fit` tunes")
    diagnosed: tuple[str, ...] = Field(
        default=(), description="causes whose place or time only `rovval diagnose` finds: it writes the vehicle that is then fitted"
    )
    command: str = Field(default="", description="the commands that write the calibrated vehicle")


class SensorFault(Interval):
    """A fault of a sensor, fitted by itself to the kinematic identities, without any dynamics."""

    check: str = Field(description="the identity: measured velocity against measured pose")
    fault: str = Field(description="parameter of a sensor's effect, as gyro_bias.r")
    value: float = Field(description="estimate, in unit")
    was: float = Field(default=0.0, description="what the vehicle's file says")
    unit: str = Field(description="unit of value, low, high and was; 1 for a ratio")
    share: float = Field(default=0.0, description="share of the squared parity residual that it takes away")
    significant: bool = Field(description="whether it differs from the file's value and takes away enough to matter")
    note: str = Field(default="", description="how it was fitted")


class NearestEffect(Candidate):
    """The candidate that came nearest to a cause, though it is not named."""

    lacks: tuple[Lack, ...] = Field(
        description="reduction: no more than coefficients within their tolerances bring; evidence (older documents): less than is asked of a cause; "
        "empty: other models are likelier"
    )


class Indications(Record):
    """What points to a cause where none is named."""

    nearest: NearestEffect | None = Field(description="the effect that came nearest; null: none came near")
    within_tolerance: float = Field(
        description="share of the gap that coefficients within their tolerances take away; 0 where the fit takes one far beyond"
    )
    fault: SensorFault | None = Field(description="the significant fault of a sensor that accounts for most of the parity residuals")
    fault_departure: float = Field(description="its standardised departure, in tolerances of a healthy sensor; 0 where none is stated")
    beyond_tolerance: bool = Field(
        description="whether one of the two is beyond what tolerances allow: no cause is named, but neither is there nothing"
    )


class LogRemark(Record):
    """A channel of a log that is no plain measurement."""

    run: str = Field(description="id of the run")
    channel: str = Field(description="which channel")
    finding: str = Field(description="one word for programs")
    detail: str = Field(description="what was found, and how it was taken")


class NextExperiment(Record):
    """The manoeuvre that separates a confusion group best, by simulation."""

    manoeuvre: str = Field(description="name and how it is flown")
    separates: tuple[str, ...] = Field(description="members of the group")
    misfit: float | None = Field(default=None, description="squared misfit of the best other member, in units of a window's noise")


class ScheduleLeg(Record):
    """A part of a manoeuvre with constant thruster speeds."""

    t_s: float = Field(description="when it begins, s after the manoeuvre's start")
    duration_s: float = Field(description="how long it lasts, s")
    thrusters: Mapping[str, float] = Field(description="speed by thruster, rpm")


class ThrusterSchedule(Record):
    """The thruster schedule of the next experiment."""

    name: str = Field(description="name")
    text: str = Field(description="how it is flown")
    unit: str = Field(default="rpm", description="unit of the thruster speeds")
    schedule: tuple[ScheduleLeg, ...] = Field(description="one leg after another")


class HeatMap(Record):
    """Where the gap lies: axis by regime."""

    axes: tuple[str, ...] = Field(description="rows")
    regimes: tuple[str, ...] = Field(description="columns")
    share: tuple[tuple[float, ...], ...] = Field(description="share of the axis's squared gap in the regime")
    lift: tuple[tuple[float, ...], ...] = Field(description="that share over the regime's share of the time")


class Trace(Record):
    """Curves of one axis in one window: what was measured, and what the two simulators say. null: not measured."""

    title: str = Field(description="axis, time and run")
    axis: str = Field(description="surge, sway, heave, roll, pitch or yaw")
    unit: str = Field(description="unit of the three curves")
    t_s: tuple[float, ...] = Field(description="time since the run's start, s")
    measured: tuple[float | None, ...] = Field(description="the vehicle")
    nominal: tuple[float | None, ...] = Field(description="the simulator as it is")
    corrected: tuple[float | None, ...] = Field(description="the simulator with the causes added")


class Coherence(Record):
    """How alike the effects' signatures are in these logs: 1 cannot be told apart, 0 share nothing."""

    effects: tuple[str, ...] = Field(description="rows and columns")
    matrix: tuple[tuple[float, ...], ...] = Field(description="first canonical correlation of the projected sensitivities")


class Diagnosis(Record):
    """Where the gap between a simulator and logs of the vehicle lies, which causes it has, and how far it shrinks with them."""

    schema_: Literal["rovval.diagnosis/1"] = Field(default=SCHEMA, alias="schema", description="name and version of this format")
    rovval: str = Field(default="", description="version of rovval")
    run: str = Field(description="ids of the runs, separated by commas")
    runs: tuple[str, ...] = Field(default=(), description="ids of the runs")
    vehicle: str = Field(description="name of the nominal vehicle")
    vehicle_hash: str = Field(default="", description="digest of its file's content")
    model: str = Field(description="platform: fossen, uuv or freefloating")
    window_s: float = Field(description="length of a window, s")
    windows: int | None = Field(default=None, description="number of windows")
    calibration_slop: float = Field(description="tolerance: relative standard deviation of a healthy simulator's coefficients")
    synthetic: str = Field(default="", description="how the data were made up; empty for data of a real vehicle")
    since_s: float | None = Field(default=None, description="time from which the log was searched, s; null: all of it")
    verdict: Verdict = Field(description="no_gap, explained, partly_explained or unknown")
    gap: Gap = Field(description="how far the nominal simulator is from the vehicle, and where")
    causes: tuple[Cause, ...] = Field(description="isolated causes; none for no_gap and unknown")
    shrinkage: Shrinkage = Field(description="with all causes")
    within_tolerance: Reduction | None = Field(
        default=None,
        validation_alias=AliasChoices("within_tolerance", "beside_slop"),
        description="reduction by the causes of what coefficients fitted within their tolerances leave; null without causes",
    )
    ranking: tuple[Score, ...] = Field(description="every effect that was screened, the best first")
    not_testable: tuple[NotTestable, ...] = Field(description="effects that these logs could not show")
    next_experiment: NextExperiment | None = Field(description="what to fly to separate a confusion group; null: nothing to separate")
    manoeuvre: ThrusterSchedule | None = Field(default=None, description="its thruster schedule")
    probabilities: Probabilities | None = Field(default=None, description="of the kinds of model that were compared; null in older documents")
    detection: Detection | None = Field(default=None, description="what the verdict rests on")
    finalists: tuple[tuple[Candidate, ...], ...] = Field(default=(), description="candidates of each step of the search")
    disturbance: Mapping[str, Disturbance] = Field(default_factory=dict, description="forces that nobody logged, by axis")
    left: Unexplained | None = Field(default=None, description="what is left unexplained; null: nothing")
    calibration: Recalibration | None = Field(default=None, description="a file that is off in many coefficients; null: it is not")
    harm: tuple[AxisHarm, ...] = Field(default=(), description="axes that get worse with the causes")
    parity: tuple[SensorFault, ...] = Field(default=(), description="faults of sensors by kinematics alone")
    indications: Indications | None = Field(default=None, description="what points to a cause where none is named; null: causes are")
    heatmap: HeatMap | None = Field(default=None, description="the gap by axis and regime, of the first run")
    traces: tuple[Trace, ...] = Field(default=(), description="the windows with the largest gap, before and after")
    coherence: Coherence | None = Field(default=None, description="how alike the effects are in these logs")
    inputs: str = Field(default="", description="what drove the simulation: the channel of the thruster speeds")
    log: tuple[LogRemark, ...] = Field(default=(), description="what of the logs is no plain measurement")
    runs_left_out: tuple[str, ...] = Field(default=(), description="runs that could not be used, and why")
    left_out_s: float = Field(default=0.0, description="time aground or held that was left out, s")
    windows_stopped: int = Field(default=0, description="windows left out because the nominal simulation stopped")
    outliers: int = Field(default=0, description="samples taken for outliers")
    answer: str = Field(default="", description="the answer in a sentence")
    sentence: str = Field(default="", description="the whole diagnosis in sentences")
    settings: SkipJsonSchema[tuple[str, ...]] = Field(default=(), exclude=True, description="the causes, as `--effect` takes them")
    vehicle_fixed: SkipJsonSchema[str] = Field(default="", exclude=True, description="TOML of the vehicle with the causes added; empty without causes")

    @computed_field(description="older key of within_tolerance")  # type: ignore[prop-decorator]
    @property
    def beside_slop(self) -> Reduction | None:
        """Older key of within_tolerance."""
        return self.within_tolerance

    def document(self) -> dict[str, Any]:
        """The diagnosis as JSON-ready dictionary (schema rovval.diagnosis/1), every key always there."""
        return self.model_dump(mode="json", by_alias=True)

    @classmethod
    def published_schema(cls) -> dict[str, Any]:
        """The JSON schema (draft 2020-12) of the documents that this version writes; further keys are welcome in it."""
        dialect = {"$schema": GenerateJsonSchema.schema_dialect}
        return dialect | cls.model_json_schema(mode="serialization", schema_generator=_Untitled)

    @classmethod
    def read(cls, document: Mapping[str, Any]) -> Self:
        """The diagnosis of a document, of this version or of another: keys unknown here are passed over, keys that came later may be missing.
        Where no cause is named, indications that an older document does not state follow from what it holds.

        Raises:
            BadInput: names every key of the contract that is missing or is not what it should be.
        """
        try:
            found = cls.model_validate(document)
        except ValidationError as error:
            problems = [f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors()]
            hint = f"a document of schema {SCHEMA}, as `rovval diagnose --json` writes it, is needed"
            raise BadInput(all_at_once(problems, f"diagnosis of {document.get('run', 'an unnamed run')}"), hint) from None
        return found if found.causes or found.indications else found.model_copy(update={"indications": found._indicated()})

    def _indicated(self) -> Indications:
        """What points to a cause, from the candidates, the sensors' faults and the shares that the diagnosis holds."""
        shares = self.detection
        known = Accounted(shares.noise, shares.tolerance_share, shares.largest_departure) if shares else Accounted(0.0, 0.0, 0.0)
        first = [(c.effect, c.evidence, c.gain) for c in (self.finalists[0] if self.finalists else ())]
        found = indications(first, known, [FittedFault(**row.model_dump()) for row in self.parity])
        return Indications.model_validate(found, from_attributes=True)
