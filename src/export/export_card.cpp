#include <algorithm>
#include <cmath>

#include "export/source_text.hpp"
#include "thermfit/error.hpp"
#include "thermfit/number.hpp"

/// Cards: how to enter a compensation at a control that this project cannot run on. What is said about a control
/// comes from the manual cited; nothing on a card was tried there.

namespace thermfit::cli {
namespace {

struct Control {
  std::string name, title;
  std::string unit;  ///< as offset_unit() knows it
  std::string enter;
  std::string sign;
  std::string moves;
  double most_um;    ///< largest offset it takes, 0 for none known
  std::string most;  ///< and what happens beyond
  std::vector<std::string> manuals;
};

const std::vector<Control>& controls() {
  static const std::vector<Control> all{
      {"sinumerik",
       "SINUMERIK 840D sl",
       "mm",
       "MD32750 $MA_TEMP_COMP_TYPE bit 0 = 1 on the axis switches the position-independent part on; the PLC writes the "
       "offset to SD43900 $SA_TEMP_COMP_ABS_VALUE, once in a period. The slope SD43910 stays 0, its reference SD43920 "
       "is "
       "then without effect.",
       "not stated in the pages cited: find it by the check below.",
       "each interpolator step is limited by MD32760 $MA_COMP_ADD_VELO_FACTOR (default 0.01, at most 0.10 of the "
       "axis's largest speed). Reaching the limit raises no alarm.",
       1000,
       "a compensation along the tool (SD42960 $SC_TOOL_TEMP_COMP) is cut at MD20392 (default 1 mm) without an alarm; "
       "keep the clamp below it.",
       {"Siemens, Function Manual Extended Functions 6FC5397-1BP40-3BA1, K3 Compensations, 4.2 Temperature "
        "compensation: "
        "https://www.easymanua.ls/siemens/sinumerik-series/manual/275710?p=228",
        "Siemens, Function Manual W1 (MD20392): "
        "https://www.easymanua.ls/siemens/sinumerik-840de-sl/manual/32519?p=1803"}},
      {"twincat",
       "TwinCAT 3 CNC (ISG kernel)",
       "0.1um",
       "lr_param.temp_comp 1 (P-AXIS-00271) on the axis, temp_comp_position_0 0 (P-AXIS-00272), temp_comp_coefficient "
       "0 "
       "(P-AXIS-00274); the offset is temp_comp_offset_0 (P-AXIS-00273), written while running as the CNC object "
       "TEMPC::offset_0, index group 0x120300. It is a 32-bit whole number: round to the nearest. Effective once "
       "the axis is referenced.",
       "not stated in the pages cited: find it by the check below.",
       "temp_comp_n_cycles spreads a step over cycles.",
       0,
       "",
       {"Beckhoff, axis parameters: https://infosys.beckhoff.com/content/1033/tccncaxisparameter/15266957451.html",
        "Beckhoff, TF5200 axis compensation, CNC objects: "
        "https://infosys.beckhoff.com/content/1033/tf5200_axis_compensation/889202827.html"}},
      {"heidenhain",
       "HEIDENHAIN TNC 360",
       "um",
       "the PLC program writes the offset as a whole number of um to the words W576…W582, one an axis. On a TNC "
       "426/430 "
       "the machine parameter TEMPCOMP holds a formula in mm instead.",
       "not stated in the pages cited: find it by the check below.",
       "the control follows at 1 um/s: a faster slew limit has no effect.",
       32767,
       "a 16-bit number holds no more.",
       {"HEIDENHAIN, TNC 335/360 Technical Manual: "
        "https://azmanual.top/manuals/797796/heidenhain-tnc-335-technical-manual.html?page=126",
        "HEIDENHAIN, TNC 426/430 Technical Manual: https://www.easymanua.ls/heidenhain/tnc-426-pb-m/manual?p=404"}},
      {"fanuc",
       "FANUC 15i/16i-MB, thermal growth along the tool vector",
       "um",
       "the PMC drives THML high, sets the data on THD00…THD15, raises the strobe THSTB until THREND answers; the data "
       "count in detection units (here taken as 1 um: check the machine). Without that option, external data input "
       "shifts the machine zero point, in the least input increment.",
       "positive data mean that the tool has grown longer, and the control moves the axis the other way: enter the "
       "predicted error, where a longer tool counts positive.",
       "the axis moves by the whole difference at once: small steps only; the slew limit does that.",
       9998,
       "9999 detection units or more at once raise an alarm.",
       {"FANUC 16i/18i-MB, A-79097E: http://cncmanuals.com/fanuc/431/fanuc-series-16i-mb-additional-manual/page/6",
        "FANUC 15i Connection Manual B-63783EN-1: "
        "http://cncmanuals.com/fanuc/256/15i-150i-model-b-connection-manual-function/page/113"}}};
  return all;
}

const Control* find_control(const std::string& name) {
  for (const Control& control : controls())
    if (control.name == name) return &control;
  return nullptr;
}

/// `value` in the control's unit, as many digits as 0.01 um needs.
std::string amount(double um, const OffsetUnit& unit) {
  return fixed_text(um * unit.per_um, unit.identifier == "mm" ? 5 : unit.identifier == "tenth_um" ? 1 : 2);
}

/// Whether the intercept drops out: relative to a datum it does, and where it was so wished.
bool through_zero(const ExportRequest& request) {
  return request.trained.reference == TemperatureReference::rise &&
         (request.wishes.zero == ZeroPolicy::wait || request.wishes.through_zero);
}

/// The offset as a formula in the control's unit: 1.2 - 3.4*T1.
std::string formula(const ExportRequest& request, Index error) {
  const TrainedModel& model = request.trained;
  const double factor = static_cast<double>(static_cast<int>(request.wishes.sign)) * request.unit.per_um;
  std::string text = general_text(through_zero(request) ? 0. : model.model.intercept(error) * factor, 9);
  const bool rise = model.reference == TemperatureReference::rise;
  for (Index i = 0; i < model.model.sensors(); ++i) {
    const double slope = model.model.coefficients(i, error) * factor;
    const std::string name = comment_text(model.temperatures[static_cast<std::size_t>(i)]);
    text += (slope < 0 ? " - " : " + ") + general_text(std::abs(slope), 9) + "*" +
            (rise ? "(" + name + " - " + name + "_zero)" : name);
  }
  if (text.rfind("0 + ", 0) == 0) return text.substr(4);
  return text.rfind("0 - ", 0) == 0 ? "-" + text.substr(4) : text;
}

}  // namespace

std::vector<std::string> card_controls() {
  std::vector<std::string> names;
  for (const Control& control : controls()) names.push_back(control.name);
  return names;
}

std::string card_unit(const std::string& control) {
  const Control* found = find_control(control);
  return found ? found->unit : "um";
}

ControllerSource export_card(const ExportRequest& request) {
  const Control& control = *find_control(request.control);
  require_formula(request, "card", "what is entered at a control is a formula");
  const auto settings = settings_for<double>(request.trained, request.wishes);
  std::string text = "# Thermal compensation at " + control.title + "\n\n**Not run on that control.** " +
                     "What is said of it comes from the manuals cited below; try it with the axes clear.\n\n";
  for (const std::string& line : facts(request)) text += line.empty() ? "\n" : "    " + line + "\n";
  text += "\n## Where to enter it\n" + control.enter + "\n\n- unit: " + request.unit.name +
          "\n- sign: the offset below is the " + sign_name(request.wishes.sign) + "; " + control.sign +
          "\n- speed: " + control.moves + "\n";
  if (!control.most.empty()) text += "- limit: " + control.most + "\n";
  text += "\n## What to enter\n";
  const auto errors = request.trained.errors;
  for (std::size_t j = 0; j < errors.size(); ++j) {
    const OutputLimits<double>& limits = settings.outputs[j];
    if (control.most_um > 0 && limits.clamp_um > control.most_um)
      throw Error("clamp of " + errors[j], exact_text(limits.clamp_um) + " um",
                  "at most " + exact_text(control.most_um) + " um on " + control.title, "give a smaller --clamp");
    text += "\nAxis " + comment_text(errors[j]) + ", in " + request.unit.name +
            ":\n\n    offset = " + formula(request, static_cast<Index>(j)) + "\n    offset = limit(-" +
            amount(limits.clamp_um, request.unit) + ", offset, " + amount(limits.clamp_um, request.unit) +
            ")\n    at most " + amount(limits.slew_um_per_step, request.unit) + " from one write to the next, every " +
            exact_text(request.wishes.period_s) + " s\n    slope over the axis position: 0\n";
  }
  if (request.trained.reference == TemperatureReference::rise) {
    text += "\n_zero: what the sensor read when ";
    text += request.wishes.zero == ZeroPolicy::first
                ? "the cold machine was switched on, as the median of several readings that agree, never a single one."
                : "the work offset was probed, as the median of several readings that agree, never a single one and "
                  "never what it read when the control was switched on. The offset is 0 there. Keep it in retentive "
                  "memory with a mark that it is valid; without one write 0.";
    text += "\n";
  }
  text += "\nReadings that make sense; outside, or when a reading is missing, keep the last offset:\n\n";
  const auto& names = request.trained.temperatures;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += "    " + comment_text(names[i]) + ": " + exact_text(settings.sensors[i].lowest_degC) + " to " +
            exact_text(settings.sensors[i].highest_degC) + " degC\n";
  text +=
      "\nThe whole guard (zero, rate, stuck and lost sensors, training domain, time-out) is in the function block of\n"
      "`thermfit export --target st`: run that in the PLC and write its output here.\n";
  const bool correction = request.wishes.sign == OutputSign::correction;
  text += "\n## Check of the sign\nWith the axis at rest and a probe on it, enter " + amount(10, request.unit) +
          " (10 um). The axis must move by 10 um towards " + (correction ? "plus" : "minus") +
          ".\nIf it moves the other way, export with --sign " + (correction ? "error" : "correction") +
          ". If it does not move, the compensation is not switched on.\n\n## Manuals\n";
  for (const std::string& manual : control.manuals) text += "- " + manual + "\n";
  return text;
}

}  // namespace thermfit::cli
