#include "export/c_source.hpp"
#include "export/source_text.hpp"
#include "thermfit/error.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

const char* const component_body = R"(
option singleton yes;
option no_convenience_defines yes;
function _ fp "reads the temperatures; steps the compensation every @period@ s";
license "GPL";
include <rtapi_math.h>;
include <float.h>;
include <stdbool.h>;
include <stddef.h>;
include <stdint.h>;
;;
@source@
static @n@_compensator device; /* one component, one machine */
static double since_step_s = @period@; /* so that the first cycle steps */
static int ready = 0;
static int running = 0;

#define FUNCTION(name) static void name(struct __comp_state *__comp_inst, long period)

FUNCTION(_) {
  const double period_s = (double)period * 1e-9;
  const int enable = *__comp_inst->enable;
  const double temperatures_degC[@N@_SENSORS] = {@inputs@};
  double offset_@unit@[@N@_ERRORS];
  uint32_t status;
  if (!ready) {
    @n@_initialise(&device);
    ready = 1;
  }
  if (enable && !running) {
    @n@_start(&device, NULL);
  }
  if (!enable && running) {
    @n@_stop(&device);
  }
  running = enable;
  since_step_s += period_s;
  if (since_step_s < @period@ - 0.5 * period_s) {
    return;
  }
  since_step_s -= @period@;
  if (since_step_s > @period@) {
    since_step_s = 0.0; /* the thread is slower than the compensation */
  }
  status = @n@_step(&device, temperatures_degC, offset_@unit@);
  *__comp_inst->status = status;
  *__comp_inst->state = @N@_STATE(status);
  *__comp_inst->sensor = @N@_SENSOR(status);
  *__comp_inst->fault = @N@_FAULT(status);
  *__comp_inst->ok = (@N@_STATE(status) == @N@_TRACKING) && ((status & (@N@_OUTSIDE_DOMAIN | @N@_CLAMPED)) == 0U);
@outputs@}
)";

std::string hal_name(std::string identifier) {
  for (char& c : identifier) c = c == '_' ? '-' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return identifier;
}

std::string c_name(std::string hal) {
  for (char& c : hal)
    if (c == '-') c = '_';
  return hal;
}

/// The pins that are made from names of the model: HAL refuses a component of which two pins are called the same, or
/// one longer than 47 characters with component and dot.
class NamedPins {
 public:
  explicit NamedPins(std::string component) : component_(std::move(component)) {}

  void add(const std::string& pin, const std::string& name) {
    const std::string whole = component_ + '.' + pin;
    if (whole.size() > 47)
      throw Error("HAL pin " + whole, std::to_string(whole.size()) + " characters, for '" + name + "'", "47",
                  "take a shorter --name, or rename the column and fit again");
    const auto [known, is_new] = names_.emplace(pin, name);
    if (!is_new)
      throw Error("HAL pin " + whole, "for '" + known->second + "' and for '" + name + "'", "one name a pin",
                  "rename a column and fit again");
  }

 private:
  std::string component_;
  std::map<std::string, std::string> names_;  ///< of the model, by pin
};

}  // namespace

ControllerSource export_linuxcnc(const ExportRequest& given) {
  ExportRequest request = given;
  request.single_precision = false;  // HAL's float is a double
  if (request.unit.identifier == "tenth_um")
    throw Error("unit", "'0.1um'", "um, mm", "HAL offsets are in machine units: use mm for a metric machine");
  std::string text = "component " + hal_name(request.name) + " \"Thermal compensation\";\ndescription \"\"\"\n";
  for (const std::string& line : facts(request)) {
    std::string safe = line;  // halcompile turns this into a manual page
    for (char& c : safe)
      if (c == '"') c = '\'';
    text += safe + "\n";
  }
  text +=
      "\nnet offset-<error>-counts to axis.<letter>.eoffset-counts, setp axis.<letter>.eoffset-scale to\n"
      "counts-scale, set axis.<letter>.eoffset-enable; the INI needs [AXIS_<letter>]OFFSET_AV_RATIO.\n\"\"\";\n";
  text += "pin in bit enable \"compensate; off ramps to zero\";\n";
  std::string inputs, outputs;
  NamedPins pins(hal_name(request.name));
  const auto temperatures = identifiers(request.trained.temperatures);
  for (std::size_t i = 0; i < temperatures.size(); ++i) {
    const std::string pin = "temperature-" + hal_name(temperatures[i]);
    pins.add(pin, request.trained.temperatures[i]);
    text += "pin in float " + pin + " \"degC\";\n";
    inputs += (inputs.empty() ? "*__comp_inst->" : ", *__comp_inst->") + c_name(pin);
  }
  const auto errors = identifiers(request.trained.errors);
  for (std::size_t j = 0; j < errors.size(); ++j) {
    const std::string pin = "offset-" + hal_name(errors[j]), index = "[" + std::to_string(j) + "]";
    pins.add(pin, request.trained.errors[j]);
    pins.add(pin + "-counts", request.trained.errors[j]);
    text += "pin out float " + pin + " \"" + request.unit.name + ", the " + sign_name(request.wishes.sign) + "\";\n";
    text += "pin out s32 " + pin + "-counts \"the same in counts of counts-scale\";\n";
    outputs += "  *__comp_inst->" + c_name(pin) + " = offset_" + request.unit.identifier + index + ";\n";
    outputs += "  *__comp_inst->" + c_name(pin) + "_counts = (rtapi_s32)floor(offset_" + request.unit.identifier +
               index + " / __comp_inst->counts_scale + 0.5);\n";
  }
  text +=
      "pin out u32 status \"status word: state 0-3, outside domain 4, clamped 5, slewing 6, sensor 8-15, fault "
      "16-19\";\n"
      "pin out u32 state \"0 off 1 starting 2 tracking 3 substituting 4 holding 5 fallback 6 stopping\";\n"
      "pin out u32 sensor \"first sensor not used, from 1; 0 none\";\n"
      "pin out u32 fault \"1 not finite 2 range 3 rate 4 stuck 5 recovering 6 no reference\";\n"
      "pin out bit ok \"all sensors used, in the training domain, not clamped\";\n"
      "param r float counts_scale = " +
      real_text(request.unit.per_um * .1) + " \"" + request.unit.name + " per count\";\n";
  return text + fill_template(component_body, {{"n", request.name},
                                               {"N", upper_case(request.name)},
                                               {"period", real_text(request.wishes.period_s)},
                                               {"unit", request.unit.identifier},
                                               {"source", c_source(request, false)},
                                               {"inputs", inputs},
                                               {"outputs", outputs}});
}

}  // namespace thermfit::cli
