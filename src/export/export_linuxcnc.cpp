#include <algorithm>

#include "export/c_source.hpp"
#include "export/source_text.hpp"
#include "thermfit/error.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

const char* const component_body = R"(
option singleton yes;
option no_convenience_defines yes;
function _ fp "hands the offsets to motion; steps the compensation every @period@ s";
license "GPL";
include <rtapi_math.h>;
include <float.h>;
include <stdbool.h>;
include <stddef.h>;
include <stdint.h>;
;;
@source@
@delivery@
static @n@_compensator device; /* one component, one machine */
static @n@_delivery deliveries[@N@_ERRORS];
static double wanted_@unit@[@N@_ERRORS];
static uint32_t status = 0U;
static double since_step_s = 0.0;
static bool ready = false;
static bool enabled = false, restored = false, probed = false; /* the pins before, for their edges */
static bool resumes = false;
@?probe@
static bool probe_before[@N@_ERRORS];
@.@
@?features@
static uint32_t shown_zero = 0U; /* the status bits of the zero when the pins to store were set last */
static double since_shown_s = 0.0;
@.@

/* What survives the text that halcmd prints, seven digits. */
static double rounded_degC(double value) { return floor(value * 1e4 + 0.5) / 1e4; }

#define FUNCTION(name) static void name(struct __comp_state *__comp_inst, long period)

FUNCTION(_) {
  const double period_s = (double)period * 1e-9;
  const bool enable = *__comp_inst->enable;
  const bool restore = *__comp_inst->restore;
  const bool datum = *__comp_inst->datum;
  const bool live = *__comp_inst->machine_on && *__comp_inst->homed && *__comp_inst->eoffset_enabled;
  const double count = __comp_inst->counts_scale;
  const double applied_@unit@[@N@_ERRORS] = {@applied@};
  hal_float_t *const offset_pins[@N@_ERRORS] = {@offset_pins@};
  hal_s32_t *const count_pins[@N@_ERRORS] = {@count_pins@};
  uint32_t delivery = @N@_DELIVERED;
  uint32_t periods = 1U;
  uint32_t j;
  if (!ready) {
    @n@_initialise(&device);
    since_step_s = @period@ - period_s; /* the first cycle steps */
    ready = true;
  }
  resumes = resumes || (restore && !restored);
  restored = restore;
  if (enable && resumes) {
    @n@_retained kept = {@set_session@@N@_VALID_MARK, @N@_MODEL, *__comp_inst->set_zero_through ? 1U : 0U, {@set_zeros@},
                         *__comp_inst->set_zero_digest};
@?plain@
    @n@_resume(&device, &kept, NULL);
@.@
@?features@
    const double off_periods = *__comp_inst->set_off / @period@;
    @n@_resume_after(&device, &kept,
                     @n@_within(off_periods, 0.0, 4e9) ? (uint32_t)(off_periods + 0.5) : @N@_OFF_UNKNOWN, NULL);
@.@
    resumes = false;
  } else if (enable && !enabled) {
    @n@_start(&device, NULL);
  } else if (!enable && enabled) {
    @n@_stop(&device);
  }
  enabled = enable;
  if (datum && !probed) {
    @n@_datum(&device);
  }
  probed = datum;
@?probe@
  {
    const bool probe_now[@N@_ERRORS] = {@probe_now@};
    const double probe_@unit@[@N@_ERRORS] = {@probe@};
    hal_u32_t *const told_pins[@N@_ERRORS] = {@probe_told@};
    for (j = 0U; j < @N@_ERRORS; j++) {
      if (probe_now[j] && !probe_before[j]) {
        *told_pins[j] = @n@_probe(&device, j, probe_@unit@[j] / @N@_UNIT_PER_UM);
      }
      probe_before[j] = probe_now[j];
    }
  }
@.@

  since_step_s += period_s;
  if (since_step_s >= @period@ - 0.5 * period_s) {
    const double temperatures_degC[@N@_SENSORS] = {@temperatures@};
    hal_float_t *const zero_pins[@N@_SENSORS] = {@zero_pins@};
    @n@_retained kept;
    uint32_t i;
    if (since_step_s > 1.5 * @period@) { /* the thread is slower than the compensation */
      periods = (uint32_t)(since_step_s / @period@ + 0.5);
    }
    since_step_s -= (double)periods * @period@;
    status = @n@_step_after(&device, temperatures_degC, periods, *__comp_inst->heartbeat, wanted_@unit@);
    *__comp_inst->status = status;
    *__comp_inst->state = @N@_STATE(status);
    *__comp_inst->sensor = @N@_SENSOR(status);
    *__comp_inst->fault = @N@_FAULT(status);
@?features@
    since_shown_s += (double)periods * @period@;
    if (since_shown_s >= 60.0 || shown_zero != (status & 0x70000000U)) {
      hal_float_t *const lag_pins[@N@_LAGS] = {@lag_pins@};
      hal_float_t *const lag_zero_pins[@N@_LAGS] = {@lag_zero_pins@};
      since_shown_s = 0.0;
      shown_zero = status & 0x70000000U;
@.@
    @n@_retain(&device, &kept);
    for (i = 0U; i < @N@_SENSORS; i++) {
      kept.zero_degC[i] = rounded_degC(kept.zero_degC[i]);
      *zero_pins[i] = kept.zero_degC[i];
    }
@?features@
      for (i = 0U; i < @N@_LAGS; i++) {
        kept.lag_degC[i] = rounded_degC(kept.lag_degC[i]);
        kept.lag_zero_degC[i] = rounded_degC(kept.lag_zero_degC[i]);
        *lag_pins[i] = kept.lag_degC[i];
        *lag_zero_pins[i] = kept.lag_zero_degC[i];
      }
      kept.climate_degC = rounded_degC(kept.climate_degC);
      *__comp_inst->climate = kept.climate_degC;
@.@
    *__comp_inst->zero_through = kept.through_zero != 0U;
    *__comp_inst->zero_digest = kept.mark != 0U ? @n@_digest_of(&kept) : 0U;
@?features@
    }
@.@
    *__comp_inst->zero_source = @N@_ZERO(status);
    *__comp_inst->zero_pending = (status & @N@_ZERO_PENDING) != 0U;
  }

  for (j = 0U; j < @N@_ERRORS; j++) {
    const double slew = @n@_slew_um_per_step[j] * @N@_UNIT_PER_UM / @period@;
    uint32_t on_its_way;
    *offset_pins[j] = wanted_@unit@[j];
    *count_pins[j] = (int32_t)((uint32_t)*count_pins[j] +
                               (uint32_t)@n@_deliver(&deliveries[j], live, wanted_@unit@[j] / count,
                                                     applied_@unit@[j] / count, slew / count, @period@, period_s));
    on_its_way = @n@_delivery_state(&deliveries[j], live, wanted_@unit@[j] / count, applied_@unit@[j] / count);
    if (on_its_way > delivery || on_its_way == @N@_DELIVERY_RESTS) {
      delivery = on_its_way;
    }
  }
  *__comp_inst->delivery = delivery;
  *__comp_inst->ok = @N@_STATE(status) == @N@_TRACKING && (status & (@N@_OUTSIDE_DOMAIN | @N@_CLAMPED)) == 0U &&
                     delivery == @N@_DELIVERED;
}
)";

const char* const delivery_body =
#include "export/linuxcnc_delivery_c.inc"
    ;

std::string hal_name(std::string identifier) {
  for (char& c : identifier) c = c == '_' ? '-' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return identifier;
}

std::string c_name(std::string hal) {
  for (char& c : hal)
    if (c == '-') c = '_';
  return hal;
}

/// Pin declarations. HAL refuses a component of which two pins are called the same, or one longer than 47 characters
/// with component and dot.
class Pins {
 public:
  explicit Pins(std::string component) : component_(std::move(component)) {}

  /// `name` is the one of the model that the pin is made from.
  void add(const std::string& type, const std::string& pin, const std::string& text, const std::string& name = "",
           const std::string& initial = "") {
    const std::string whole = component_ + '.' + pin;
    if (whole.size() > 47)
      throw Error("HAL pin " + whole, std::to_string(whole.size()) + " characters, for '" + name + "'", "47",
                  "take a shorter --name, or rename the column and fit again");
    const auto [known, is_new] = names_.emplace(pin, name);
    if (!is_new)
      throw Error("HAL pin " + whole, "for '" + known->second + "' and for '" + name + "'", "one name a pin",
                  "rename a column and fit again");
    text_ += "pin " + type + " " + pin + (initial.empty() ? "" : " = " + initial) + " \"" + text + "\";\n";
  }
  const std::string& text() const { return text_; }

 private:
  std::string component_, text_;
  std::map<std::string, std::string> names_;  ///< of the model, by pin
};

/// C initialisers of one value for each name.
std::string each(const std::vector<std::string>& names, const std::string& before, const std::string& after = "") {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + before + c_name(hal_name(name)) + after;
  return list;
}

const char* const manual = R"(
For each error and its axis, here Z:
  net z-counts  @p@.offset-z-counts => axis.z.eoffset-counts
  net z-applied axis.z.eoffset => @p@.applied-z
  setp axis.z.eoffset-scale @scale@
  setp axis.z.eoffset-enable 1
and [AXIS_Z]OFFSET_AV_RATIO in the INI. An error that no axis corrects, or that is applied by other means:
  net y-offset @p@.offset-y => @p@.applied-y
The state of the machine, for all:
  net machine-on motion.motion-enabled => @p@.machine-on
  net homed motion.is-all-homed => @p@.homed
Where a signal switches axis.z.eoffset-enable, net it to eoffset-enabled as well. addf in the servo thread.

Motion adds changes of eoffset-counts, times the scale, while the machine is on, homed and the offset enabled; other
changes are lost, and each machine-on begins at no offset. So the counts are no measure of the offset: they are moved by
what is missing between offset and applied, at most as fast as the slew limit, and only after motion has come to rest at
what it was given before. What does not arrive is taken back; one count is then tried until it does. In joint mode, at a
soft limit and while eoffset-clear is set nothing arrives: delivery says so. After machine-on the axis goes to its offset
at the slew limit. ok is true only where every applied offset is the wanted one within a count.

Temperatures that are not netted read NaN, and are not used. Where readings come from another process or a bus, let it
change heartbeat with each new set.

Pulse datum whenever the work offset is probed. To keep the zero over a power cycle, store zero-<sensor>, zero-through
and zero-digest when zero-digest changes; next time set set-zero-<sensor>, set-zero-through and set-zero-digest to them,
then raise restore. What was stored torn, or for another model, is refused: zero-source stays 0.
@?features@

The model has lags: store lag-<n>, lag-zero-<n> and climate with the zero. They are set once a minute and when the zero
changes, so that a script reads them together. Next time set set-off to the seconds since they were read: not known, the
zero is refused too.
@.@
@?probe@

Set probe-<error> to what a probe has measured, the whole thermal error since the zero (what is left of it, less the
offset applied; plus it with --sign error), and pulse probe-<error>-now; probe-<error>-told says what became of it.
@.@
)";

}  // namespace

ControllerSource export_linuxcnc(const ExportRequest& given) {
  ExportRequest request = given;
  request.single_precision = false;  // HAL's float is a double
  if (request.unit.identifier == "tenth_um")
    throw Error("unit", "'0.1um'", "um, mm", "HAL offsets are in machine units: use mm for a metric machine");
  const std::string prefix = hal_name(request.name), scale = real_text(request.unit.per_um * .1);
  std::string text = "component " + prefix + " \"Thermal compensation\";\ndescription \"\"\"\n";
  for (const std::string& line : facts(request)) {
    std::string safe = line;  // halcompile turns this into a manual page
    for (char& c : safe)
      if (c == '"') c = '\'';
    text += safe + "\n";
  }
  const bool derived = !request.trained.features.empty(), probe = request.wishes.probe;
  const std::vector<std::string> parts{derived ? "features" : "plain", probe ? "probe" : "unprobed"};
  std::vector<std::string> lags;
  if (derived) {
    const std::size_t count = std::max<std::size_t>(1, detail::lags_of(request.trained).size());
    for (std::size_t k = 1; k <= count; ++k) lags.push_back(std::to_string(k));
  }
  text += fill_template(chosen_parts(manual, parts), {{"p", prefix}, {"scale", scale}}) + "\"\"\";\n";
  const auto sensors = identifiers(request.trained.temperatures), errors = identifiers(request.trained.errors);
  Pins pins(prefix);
  const auto add_for_sensors = [&](const std::string& type, const std::string& before, const std::string& what) {
    for (std::size_t i = 0; i < sensors.size(); ++i)
      pins.add(type, before + hal_name(sensors[i]), what, request.trained.temperatures[i], "NAN");
  };
  pins.add("in bit", "enable", "compensate; off ramps to zero");
  add_for_sensors("in float", "temperature-", "degC");
  pins.add("in u32", "heartbeat", "changes whenever the temperatures are new; always 0: there is none");
  for (std::size_t j = 0; j < errors.size(); ++j) {
    const std::string &name = request.trained.errors[j], error = hal_name(errors[j]);
    pins.add("out float", "offset-" + error, request.unit.name + ", the " + sign_name(request.wishes.sign), name);
    pins.add("out s32", "offset-" + error + "-counts", "for eoffset-counts: changes count, times counts-scale", name);
    pins.add("in float", "applied-" + error, request.unit.name + ", axis.<letter>.eoffset", name);
  }
  pins.add("in bit", "machine-on", "motion.motion-enabled");
  pins.add("in bit", "homed", "all joints are: motion.is-all-homed");
  pins.add("in bit", "eoffset-enabled", "axis.<letter>.eoffset-enable, where it is switched", "", "1");
  pins.add("out u32", "delivery",
           "0 rests: machine off, not homed or not enabled 1 arrived 2 on its way 3 does not arrive");
  pins.add("out bit", "ok", "all sensors used, in the training domain, not clamped, arrived");
  pins.add("in bit", "datum", "rising: the work offset is probed now, the offset becomes 0 here");
  add_for_sensors("out float", "zero-", "degC, the zero; nan: none");
  pins.add("out bit", "zero-through", "the offset is 0 at the zero");
  pins.add("out u32", "zero-digest", "of the zero; 0: there is none");
  pins.add("out u32", "zero-source", "0 none 1 first samples 2 datum 3 restored");
  pins.add("out bit", "zero-pending", "a zero was asked for and is not there yet");
  add_for_sensors("in float", "set-zero-", "degC, the same pin without set- of before");
  pins.add("in bit", "set-zero-through", "zero-through of before");
  pins.add("in u32", "set-zero-digest", "zero-digest of before");
  for (const std::string& lag : lags) {
    const std::string what = "degC, lag " + lag + " of temperatures, to be stored with the zero";
    pins.add("out float", "lag-" + lag, what, "", "NAN");
    pins.add("out float", "lag-zero-" + lag, what + ": where it was then", "", "NAN");
    pins.add("in float", "set-lag-" + lag, "degC, lag-" + lag + " of before", "", "NAN");
    pins.add("in float", "set-lag-zero-" + lag, "degC, lag-zero-" + lag + " of before", "", "NAN");
  }
  if (derived) {
    pins.add("out float", "climate", "degC, mean temperature where the session began, to be stored with the zero");
    pins.add("in float", "set-climate", "degC, climate of before");
    pins.add("in float", "set-off", "s since the pins to store were read; nan: not known, no lags, no zero", "", "NAN");
  }
  for (std::size_t j = 0; j < errors.size() && probe; ++j) {
    const std::string &name = request.trained.errors[j], error = hal_name(errors[j]);
    pins.add("in float", "probe-" + error, request.unit.name + ", the whole thermal error measured by a probe", name);
    pins.add("in bit", "probe-" + error + "-now", "rising: it was measured now", name);
    pins.add("out u32", "probe-" + error + "-told",
             "0 taken 1 no number 2 too large 3 to be repeated 4 nothing to compare with", name);
  }
  pins.add("in bit", "restore", "rising: (re)starts relative to the zero of the set-zero pins");
  pins.add("out u32", "status",
           "status word: state 0-3, outside domain 4, clamped 5, slewing 6, sensor 8-15, fault 16-19, sensors not used "
           "20-27, zero-source 28-29, zero-pending 30" +
               std::string(probe ? ", a probe corrects 31" : ""));
  pins.add("out u32", "state", "0 off 1 starting 2 tracking 3 substituting 4 holding 5 fallback 6 stopping 7 no datum");
  pins.add("out u32", "sensor", "first sensor not used, from 1; 0 none");
  pins.add("out u32", "fault", "1 not finite 2 range 3 rate 4 stuck 5 recovering 6 no reference 7 stale 8 disagrees");
  text += pins.text() + "param r float counts_scale = " + scale + " \"" + request.unit.name + " per count\";\n";
  const std::string pin = "__comp_inst->";
  return text + fill_template(
                    chosen_parts(component_body, parts),
                    {{"n", request.name},
                     {"set_session", derived ? "{" + each(lags, "rounded_degC(*" + pin + "set_lag_", ")") + "}, {" +
                                                   each(lags, "rounded_degC(*" + pin + "set_lag_zero_", ")") +
                                                   "}, rounded_degC(*" + pin + "set_climate), "
                                             : ""},
                     {"lag_pins", each(lags, pin + "lag_")},
                     {"lag_zero_pins", each(lags, pin + "lag_zero_")},
                     {"probe", each(errors, "*" + pin + "probe_")},
                     {"probe_now", each(errors, "*" + pin + "probe_", "_now")},
                     {"probe_told", each(errors, pin + "probe_", "_told")},
                     {"N", upper_case(request.name)},
                     {"period", real_text(request.wishes.period_s)},
                     {"unit", request.unit.identifier},
                     {"source", c_source(request, false)},
                     {"delivery", fill_template(delivery_body, {{"n", request.name}, {"N", upper_case(request.name)}})},
                     {"temperatures", each(sensors, "*" + pin + "temperature_")},
                     {"applied", each(errors, "*" + pin + "applied_")},
                     {"offset_pins", each(errors, pin + "offset_")},
                     {"count_pins", each(errors, pin + "offset_", "_counts")},
                     {"zero_pins", each(sensors, pin + "zero_")},
                     {"set_zeros", each(sensors, "rounded_degC(*" + pin + "set_zero_", ")")}});
}

}  // namespace thermfit::cli
