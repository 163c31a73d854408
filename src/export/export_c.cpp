#include "export/c_source.hpp"
#include "export/source_text.hpp"
#include "export/test_vectors.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

const char* const body =
#include "export/compensator_c.inc"
    ;

const char* const usage = R"(   @n@_initialise once; then @n@_resume with the zero that was kept over a power cycle, or
   @n@_start where none is kept; then one @n@_step every @period@ s. @n@_stop ramps to zero.

   What the control must provide:
   - A zero: the thermal state that offsets are relative to, the one in which the work offset was probed.
     Call @n@_datum whenever it is probed. Store what @n@_retain gives whenever @N@_ZERO(status) or
     the bit @N@_ZERO_PENDING has changed, and hand it to @n@_resume.
     Without a zero @without@.
   - New readings, or NaN. Where they come over a bus that can go silent, a heartbeat that changes with each new set
     of them, to @n@_step_after.
   - The number of periods that have passed, to @n@_step_after, where cycles can be lost.
@?features@
   - Where there are lags: how long the power was off, in periods, to @n@_resume_after, with what @n@_retain gave a minute
     before it went at most; @n@_step also while it is off. Not known, there is no zero until a datum.
@.@
@?probe@
   - What a probe measures now and then, to @n@_probe.
@.@

)";

const char* const self_test = R"(
#ifdef @N@_SELF_TEST
/* Courses of readings with the offsets and states they must lead to: define @N@_SELF_TEST in one source file and call
   @n@_self_test() on the machine itself. */
#ifndef @N@_SELF_TEST_TOLERANCE
#define @N@_SELF_TEST_TOLERANCE @tolerance@ /* um; other compilers may fuse multiplications and additions */
#endif

typedef struct {
  uint32_t repeat;
  uint32_t command; /* before the first repeat: 0 none, 1 start, 2 stop, 3 datum, 4 power cycle, 5 the same with a torn
                       copy of the zero */
  uint32_t periods;
  uint32_t beat; /* the heartbeat grows by this at each step */
  @n@_real temperatures_degC[@N@_SENSORS];
  @n@_real offset_um[@N@_ERRORS];
  uint32_t status;
} @n@_vector;

static const @n@_vector @n@_vectors[] = {
@vectors@};
#define @N@_VECTORS @vector_count@U

/* 0 when every vector came out as it must; else the number, from 1, of the first that did not. */
static inline uint32_t @n@_self_test(void) {
  @n@_compensator self;
  @n@_retained retained;
  uint32_t heartbeat = 0U;
  uint32_t failed = 0U;
  uint32_t v;
  @n@_initialise(&self);
  for (v = 0U; (v < @N@_VECTORS) && (failed == 0U); v++) {
    const @n@_vector *const vector = &@n@_vectors[v];
    @n@_real offset[@N@_ERRORS];
    uint32_t n;
    uint32_t j;
    if (vector->command == 1U) {
      @n@_start(&self, NULL);
    } else if (vector->command == 2U) {
      @n@_stop(&self);
    } else if (vector->command == 3U) {
      @n@_datum(&self);
    } else if (vector->command >= 4U) {
      @n@_retain(&self, &retained);
      if (vector->command == 5U) {
        retained.digest ^= 1U;
      }
      @n@_initialise(&self);
@?plain@
      @n@_resume(&self, &retained, NULL);
@.@
@?features@
      @n@_resume_after(&self, &retained, @OFF@, NULL);
@.@
    } else {
      /* goes on */
    }
    for (n = 0U; n < vector->repeat; n++) {
      heartbeat += vector->beat;
      (void)@n@_step_after(&self, vector->temperatures_degC, vector->periods, heartbeat, offset);
    }
    if (self.status != vector->status) {
      failed = v + 1U;
    }
    for (j = 0U; j < @N@_ERRORS; j++) {
      if (!(@n@_magnitude(self.offset_um[j] - vector->offset_um[j]) <= @N@_SELF_TEST_TOLERANCE)) {
        failed = v + 1U;
      }
    }
  }
  return failed;
}
#endif /* @N@_SELF_TEST */
)";

/// The C text of values of one number type.
template <class Scalar>
struct CText {
  std::string n;  ///< prefix

  std::string literal(Scalar value) const {
    if (std::isnan(value)) return "(" + n + "_real)NAN";
    if (std::isinf(value)) return (value < 0 ? "-(" : "(") + n + "_real)INFINITY";
    return real_text(value) + (std::is_same_v<Scalar, float> ? "F" : "");
  }
  std::string literal(std::uint32_t value) const { return std::to_string(value) + "U"; }
  std::string literal(bool value) const { return value ? "true" : "false"; }
  template <class T>
  std::string literal(const std::vector<T>& values) const {
    std::string text;
    for (const auto& value : values) text += (text.empty() ? "{" : ", ") + literal(static_cast<const T&>(value));
    return text + "}";
  }
  std::string literal(const std::vector<bool>& values) const {
    std::string text;
    for (const bool value : values) text += (text.empty() ? "{" : ", ") + literal(value);
    return text + "}";
  }
  template <class T>
  std::string array(const std::string& type, const std::string& name, const std::string& sizes, const T& values,
                    const std::string& comment = "") const {
    return "static const " + type + " " + n + "_" + name + sizes + " = " + literal(values) + ";" +
           (comment.empty() ? "" : " /* " + comment + " */") + "\n";
  }
};

template <class Model>
bool has_features(const Model& model) {
  return !model.features.channels.empty();
}

/// How many numbers the coefficients multiply, by the name of the constant.
template <class Model>
std::string inputs_name(const Model& model, const std::string& N) {
  return N + (has_features(model) ? "_FEATURES" : "_SENSORS");
}

/// Derived channels and lags; C has no arrays of length 0, and one lag that nothing is made of adds nothing.
template <class Scalar>
std::string feature_constants(const typename HostCompensator<Scalar>::Model& model,
                              const typename HostCompensator<Scalar>::Settings& settings, const std::string& n) {
  const CText<Scalar> c{n};
  const std::string N = upper_case(n);
  std::vector<std::uint32_t> kind, sensor, other, lag;
  std::vector<std::uint32_t> lag_sensor(model.features.lag_sensor.begin(), model.features.lag_sensor.end());
  for (const ControllerFeature& channel : model.features.channels) {
    kind.push_back(static_cast<std::uint32_t>(channel.kind));
    sensor.push_back(channel.sensor);
    other.push_back(channel.other);
    lag.push_back(channel.lag);
  }
  std::vector<Scalar> share = settings.features.lag_share;
  if (share.empty()) share = {1}, lag_sensor = {0};
  const auto define = [&](const std::string& name, const std::string& value, const std::string& comment) {
    return "#define " + N + "_" + name + " " + value + " /* " + comment + " */\n";
  };
  std::string text =
      define("FEATURES", c.literal(static_cast<std::uint32_t>(kind.size())), "derived channels, each a coefficient") +
      define("LAGS", c.literal(static_cast<std::uint32_t>(share.size())), "first-order lags of temperatures") +
      define("FEATURE_RISE", "0U", "of a sensor since the zero, K") +
      define("FEATURE_LAG", "1U", "the same through a lag, K") +
      define("FEATURE_CLIMATE", "2U", "the same times how far the session began from the mean climate, K^2") +
      define("FEATURE_DIFFERENCE", "3U", "rise of a sensor less that of another, K") +
      define("CLIMATE_LOWEST_DEGC", c.literal(model.features.climate_lowest_degC), "of training") +
      define("CLIMATE_HIGHEST_DEGC", c.literal(model.features.climate_highest_degC), "of training") +
      define("CLIMATE_MEAN_DEGC", c.literal(model.features.climate_mean_degC), "of training") +
      define("SESSION_STEPS", c.literal(settings.features.session_steps), "a pause after which a session begins");
  const std::string per_feature = "[" + N + "_FEATURES]", per_lag = "[" + N + "_LAGS]";
  return text + c.array("uint32_t", "feature_kind", per_feature, kind) +
         c.array("uint32_t", "feature_sensor", per_feature, sensor) +
         c.array("uint32_t", "feature_other", per_feature, other, "of a difference, the one taken off") +
         c.array("uint32_t", "feature_lag", per_feature, lag) + c.array("uint32_t", "lag_sensor", per_lag, lag_sensor) +
         c.array(n + "_real", "lag_share", per_lag, share, "of the way, in a period: 1 - exp(-period / lag)");
}

template <class Scalar>
std::string constants(const typename HostCompensator<Scalar>::Model& model,
                      const typename HostCompensator<Scalar>::Settings& settings, const ExportRequest& request) {
  const CText<Scalar> c{request.name};
  const std::string n = request.name, N = upper_case(n), real = n + "_real";
  const std::string per_sensor = "[" + N + "_SENSORS]", per_error = "[" + N + "_ERRORS]",
                    per_component = "[" + N + "_COMPONENTS]", per_input = "[" + inputs_name(model, N) + "]";
  const auto define = [&](const std::string& name, const std::string& value, const std::string& comment = "") {
    return "#define " + N + "_" + name + " " + value + (comment.empty() ? "" : " /* " + comment + " */") + "\n";
  };
  std::string text;
  text += define("SENSORS", c.literal(static_cast<std::uint32_t>(model.sensors())));
  text += define("ERRORS", c.literal(static_cast<std::uint32_t>(model.errors())));
  text += define("COMPONENTS", c.literal(static_cast<std::uint32_t>(model.domain.rotations.size())),
                 "of the training domain");
  if (has_features(model)) text += feature_constants<Scalar>(model, settings, n);
  text += define("RISE", c.literal(model.rise), "temperatures count from a zero");
  text += define("MODEL", c.literal(model.identity), "a zero that was kept belongs to one");
  text += define("UNIT_PER_UM", c.literal(static_cast<Scalar>(request.unit.per_um)), request.unit.name + " per um");
  text += define("LOST_AFTER_STEPS", c.literal(settings.patience.lost_after_steps));
  text += define("RECOVER_AFTER_STEPS", c.literal(settings.patience.recover_after_steps));
  text += define("OTHERS_MOVED_K", c.literal(settings.patience.others_moved_K));
  text += define("STALE_STEPS", c.literal(settings.stale_steps), "without a new heartbeat");
  text += define("TAKES_FIRST", c.literal(settings.zero.policy == ZeroPolicy::first),
                 "without a zero, from the first samples");
  text += define("THROUGH_ZERO", c.literal(settings.zero.through_zero), "then without the intercept");
  text += define("ZERO_SAMPLES", c.literal(settings.zero.samples), "that must agree");
  text += define("DOMAIN_IGNORE", "0U") + define("DOMAIN_WARN", "1U") + define("DOMAIN_SHRINK", "2U") +
          define("DOMAIN_HOLD", "3U");
  text += define("DOMAIN_POLICY", N + "_DOMAIN_" + upper_case(policy_name(settings.domain_policy)));
  text += define("T2_LIMIT", c.literal(model.domain.t2_limit)) + define("SPE_LIMIT", c.literal(model.domain.spe_limit));

  text += "\n/* The model: error[j] = intercept[j] + sum over i of coefficients[j][i] * temperature[i]. */\n";
  text += c.array(real, "coefficients", per_error + per_input, model.equation.coefficients, "um/K");
  text += c.array(real, "intercept_um", per_error, model.equation.intercept_um);
  text += "/* The same without sensor i. */\n";
  text += c.array("bool", "has_substitute", per_sensor, model.has_substitute);
  std::vector<std::vector<std::vector<Scalar>>> coefficients;
  std::vector<std::vector<Scalar>> intercepts;
  for (const auto& substitute : model.substitutes) {
    coefficients.push_back(substitute.coefficients);
    intercepts.push_back(substitute.intercept_um);
  }
  text += c.array(real, "substitute_coefficients", per_sensor + per_error + per_input, coefficients);
  text += c.array(real, "substitute_intercept_um", per_sensor + per_error, intercepts);
  text +=
      c.array(real, "agreement_um", per_sensor + per_error, model.agreement_um, "for sensor i to agree; 0: not known");
  text += "/* The training domain. */\n";
  text += c.array(real, "mean", per_input, model.domain.mean) +
          c.array(real, "inverse_scale", per_input, model.domain.inverse_scale) +
          c.array(real, "rotations", per_component + per_input, model.domain.rotations) +
          c.array(real, "loadings", per_component + per_input, model.domain.loadings) +
          c.array(real, "inverse_score_variance", per_component, model.domain.inverse_score_variance) +
          c.array(real, "centre_um", per_error, model.centre_um);
  text += "/* What a working sensor can do. */\n";
  std::vector<Scalar> lowest, highest, step, first_lowest, first_highest, agree, clamp, slew;
  std::vector<std::uint32_t> stuck, frozen;
  for (const auto& sensor : settings.sensors) {
    lowest.push_back(sensor.lowest_degC);
    highest.push_back(sensor.highest_degC);
    step.push_back(sensor.largest_step_K);
    stuck.push_back(sensor.stuck_steps);
    frozen.push_back(sensor.frozen_steps);
    first_lowest.push_back(sensor.first_lowest_degC);
    first_highest.push_back(sensor.first_highest_degC);
    agree.push_back(sensor.agree_K);
  }
  for (const auto& output : settings.outputs) {
    clamp.push_back(output.clamp_um);
    slew.push_back(output.slew_um_per_step);
  }
  text += c.array(real, "lowest_degC", per_sensor, lowest) + c.array(real, "highest_degC", per_sensor, highest) +
          c.array(real, "largest_step_K", per_sensor, step) + c.array("uint32_t", "stuck_steps", per_sensor, stuck) +
          c.array("uint32_t", "frozen_steps", per_sensor, frozen) +
          c.array(real, "first_lowest_degC", per_sensor, first_lowest, "where a first zero may lie") +
          c.array(real, "first_highest_degC", per_sensor, first_highest) +
          c.array(real, "agree_K", per_sensor, agree, "samples of a machine at rest");
  text += "static const uint32_t " + n + "_all_frozen_steps = " + c.literal(settings.patience.all_frozen_steps) + ";\n";
  text += "/* What an axis may do. */\n";
  text += "static const uint32_t " + n + "_hold_steps = " + c.literal(settings.hold_steps) + ";\n";
  text += c.array(real, "clamp_um", per_error, clamp) + c.array(real, "slew_um_per_step", per_error, slew);
  if (request.wishes.probe) {
    std::vector<Scalar> largest, jump, longest;
    for (const auto& probe : settings.probe) {
      largest.push_back(probe.largest_um);
      jump.push_back(probe.jump_um);
      longest.push_back(probe.longest_s);
    }
    text += "/* What a probe's reading is judged by. */\n";
    text += c.array(real, "probe_largest_um", per_error, largest) + c.array(real, "probe_jump_um", per_error, jump) +
            c.array(real, "probe_longest_steps", per_error, longest);
  }
  return text;
}

template <class Scalar>
std::string c_compensator(const ExportRequest& request, bool with_self_test) {
  constexpr bool single = std::is_same_v<Scalar, float>;
  auto model = narrow_model<Scalar>(request.trained, request.wishes.domain_limit);
  const auto settings = settings_for<Scalar>(request.trained, request.wishes);
  if (model.domain.rotations.empty()) {  // C has no arrays of length 0; one component of zeros adds nothing
    model.domain.rotations = model.domain.loadings = {std::vector<Scalar>(model.inputs())};
    model.domain.inverse_score_variance = {0};
  }
  const std::string n = request.name;
  const CText<Scalar> c{n};
  std::string vectors;
  std::size_t count = 0;
  if (with_self_test) {
    for (const TestVector<Scalar>& vector : TestCourse<Scalar>(model, settings).run_all()) {
      ++count;
      vectors += "    {" + c.literal(vector.repeat) + ", " + c.literal(std::uint32_t{vector.command}) + ", " +
                 c.literal(vector.periods) + ", " + c.literal(vector.beat) + ", " + c.literal(vector.readings_degC) +
                 ", " + c.literal(vector.offset_um) + ", " + c.literal(vector.status) + "},\n";
    }
  }
  using Guard = DomainGuard<Scalar, dynamic_size, dynamic_size>;
  const bool lags = !model.features.lag_sensor.empty();
  const std::string known_off = lags ? " &&\n      (off_periods != " + upper_case(n) + "_OFF_UNKNOWN)" : "";
  const std::string stored_too = lags ? ", and every minute for where the lags are" : "";
  const std::vector<std::string> parts{has_features(model) ? "features" : "plain",
                                       request.wishes.probe ? "probe" : "unprobed"};
  const std::map<std::string, std::string> values{
      {"n", n},
      {"N", upper_case(n)},
      {"0", c.literal(Scalar(0))},
      {"1", c.literal(Scalar(1))},
      {"NO_ZERO", c.literal(Scalar(-1e9))},
      {"MOST_OWN", c.literal(Scalar(0.99))},
      {"sqrt", single ? "sqrtf" : "sqrt"},
      {"REAL_MAX", single ? "FLT_MAX" : "DBL_MAX"},
      {"SIGN", request.wishes.sign == OutputSign::correction ? "-" : ""},
      {"sign", sign_name(request.wishes.sign)},
      {"period", exact_text(request.wishes.period_s)},
      {"UNIT", request.unit.name},
      {"unit", request.unit.identifier},
      {"INPUTS", inputs_name(model, upper_case(n))},
      {"SWEEPS", std::to_string(Guard::fill_in_sweeps) + "U"},
      {"LEFT", request.wishes.sign == OutputSign::correction ? "less the offset applied" : "and the offset applied"},
      {"OFF", c.literal(TestCourse<Scalar>::off_periods)},
      {"KNOWN_OFF", known_off},
      {"STORED_TOO", stored_too},
      {"vectors", vectors},
      {"vector_count", std::to_string(count)},
      {"tolerance", single ? "1.0e-3F" : "1.0e-9"}};
  return "typedef " + std::string(single ? "float " : "double ") + n + "_real;\n\n" +
         constants<Scalar>(model, settings, request) + fill_template(chosen_parts(body, parts), values) +
         (with_self_test ? fill_template(chosen_parts(self_test, parts), values) : "");
}

}  // namespace

std::string c_source(const ExportRequest& request, bool with_self_test) {
  return request.single_precision ? c_compensator<float>(request, with_self_test)
                                  : c_compensator<double>(request, with_self_test);
}

ControllerSource export_c(const ExportRequest& request) {
  const std::string N = upper_case(request.name);
  return "/* Thermal compensation, C99.\n\n" +
         fill_template(
             chosen_parts(usage, {request.trained.features.empty() ? "plain" : "features",
                                  request.wishes.probe ? "probe" : "unprobed"}),
             {{"n", request.name},
              {"N", N},
              {"period", exact_text(request.wishes.period_s)},
              {"without", request.trained.reference != TemperatureReference::rise ? "the temperatures count absolutely"
                          : request.wishes.zero == ZeroPolicy::first
                              ? "the first samples become the zero, as on a machine always started cold"
                              : "there is no compensation and the state is " + N + "_NO_DATUM"}}) +
         fact_comment(request, "  ") + "*/\n#ifndef " + N + "_H\n#define " + N + "_H\n\n" + R"(#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && (__FINITE_MATH_ONLY__ + 0)) || defined(_M_FP_FAST)
#error "needs comparisons that NaN fails: build without -ffast-math, -ffinite-math-only and /fp:fast"
#endif

)" + c_source(request, true) +
         "\n#endif /* " + N + "_H */\n";
}

}  // namespace thermfit::cli
