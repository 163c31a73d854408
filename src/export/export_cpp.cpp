#include "export/source_text.hpp"
#include "export/test_vectors.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

/// Values as initialisers of std::array and of the structs of thermfit/controller.
template <class Scalar>
struct CppText {
  static std::string literal(Scalar value) { return real_text(value) + (std::is_same_v<Scalar, float> ? "f" : ""); }
  static std::string literal(bool value) { return value ? "true" : "false"; }
  static std::string literal(const typename HostCompensator<Scalar>::Model::Equation& equation) {
    return "{" + literal(equation.coefficients) + ", " + literal(equation.intercept_um) + "}";
  }
  static std::string literal(const SensorLimits<Scalar>& limits) {
    return "{" + literal(limits.lowest_degC) + ", " + literal(limits.highest_degC) + ", " +
           literal(limits.largest_step_K) + ", " + std::to_string(limits.stuck_steps) + "u, " +
           std::to_string(limits.frozen_steps) + "u, " + literal(limits.first_lowest_degC) + ", " +
           literal(limits.first_highest_degC) + ", " + literal(limits.agree_K) + "}";
  }
  static std::string literal(std::uint8_t value) { return std::to_string(value); }
  static std::string literal(const ControllerFeature& channel) {
    const char* const kinds[] = {"rise", "lag", "climate", "difference"};
    return std::string("{thermfit::ControllerFeatureKind::") + kinds[static_cast<int>(channel.kind)] + ", " +
           std::to_string(channel.sensor) + ", " + std::to_string(channel.other) + ", " + std::to_string(channel.lag) +
           "}";
  }
  static std::string literal(const ProbeLimits<Scalar>& limits) {
    return "{" + literal(limits.largest_um) + ", " + literal(limits.jump_um) + ", " + literal(limits.longest_s) + "}";
  }
  static std::string literal(const OutputLimits<Scalar>& limits) {
    return "{" + literal(limits.clamp_um) + ", " + literal(limits.slew_um_per_step) + "}";
  }
  template <class T>
  static std::string literal(const std::vector<T>& values) {
    if (values.empty()) return "{}";
    std::string text;
    for (const auto& value : values) text += (text.empty() ? "{{" : ", ") + literal(static_cast<const T&>(value));
    return text + "}}";
  }
};

template <class Scalar>
std::string cpp_compensator(const ExportRequest& request) {
  const auto model = narrow_model<Scalar>(request.trained, request.wishes.domain_limit);
  const auto settings = settings_for<Scalar>(request.trained, request.wishes);
  const auto text = [](const auto& value) { return CppText<Scalar>::literal(value); };
  const auto& domain = model.domain;
  const auto& all = model.features;
  const bool lagged = !all.channels.empty();
  const std::string sizes = !lagged && !request.wishes.probe
                                ? ""
                                : ", " + std::to_string(all.channels.size()) + ", " +
                                      std::to_string(all.lag_sensor.size()) + ", " +
                                      std::to_string(request.wishes.probe ? model.errors() : 0);
  const std::string features = !lagged ? "{}"
                                       : "{" + text(all.channels) + ", " + text(all.lag_sensor) + ",\n     " +
                                             text(all.climate_lowest_degC) + ", " + text(all.climate_highest_degC) +
                                             ", " + text(all.climate_mean_degC) + "}";
  const std::string rule =
      !lagged ? "{}"
              : "{" + text(settings.features.lag_share) + ", " + std::to_string(settings.features.session_steps) + "u}";
  const std::string probe = request.wishes.probe ? text(settings.probe) : "{}";
  const std::string scalar = std::is_same_v<Scalar, float> ? "float" : "double";
  return "namespace " + request.name + " {\n\nusing Compensator = thermfit::Compensator<" + scalar + ", " +
         std::to_string(model.sensors()) + ", " + std::to_string(model.errors()) + ", " +
         std::to_string(domain.rotations.size()) + sizes + ">;\n\ninline constexpr Compensator::Model model{\n    " +
         text(model.rise) + ",  // temperatures count from a zero\n    " + features + ",  // derived channels\n    " +
         text(model.equation) + ",  // um/K, intercept um\n    " + text(model.substitutes) + ",\n    " +
         text(model.has_substitute) + ",  // sensors that have a substitute\n    " + text(model.agreement_um) +
         ",  // um, how near its substitute is then\n    {" + text(domain.mean) + ", " + text(domain.inverse_scale) +
         ",\n     " + text(domain.rotations) + ",\n     " + text(domain.loadings) + ",\n     " +
         text(domain.inverse_score_variance) + ", " + text(domain.t2_limit) + ", " + text(domain.spe_limit) +
         "},\n    " + text(model.centre_um) + ",\n    " + std::to_string(model.identity) +
         "u};\n\ninline constexpr Compensator::Settings settings{\n    " + text(settings.sensors) +
         ",  // lowest, highest degC, largest step K, stuck, frozen steps, first lowest, highest degC, agree K\n    {" +
         std::to_string(settings.patience.lost_after_steps) + "u, " +
         std::to_string(settings.patience.recover_after_steps) + "u, " + text(settings.patience.others_moved_K) + ", " +
         std::to_string(settings.patience.all_frozen_steps) + "u},\n    " + std::to_string(settings.hold_steps) +
         "u,  // hold\n    thermfit::DomainPolicy::" + policy_name(settings.domain_policy) + ",\n    " + rule +
         ",  // of lags\n    " + probe + ",  // probe\n    " + text(settings.outputs) +
         ",  // clamp um, slew um per step\n    thermfit::OutputSign::" + sign_name(settings.sign) +
         ",\n    {thermfit::ZeroPolicy::" + zero_name(settings.zero.policy) + ", " +
         std::to_string(settings.zero.samples) + "u, " + text(settings.zero.through_zero) +
         "},  // samples, whether a first zero goes through zero\n    " + std::to_string(settings.stale_steps) +
         "u};  // stale\nstatic_assert(thermfit::broken_rule(settings) == nullptr);\n\n/// " + request.unit.name +
         " per um of Compensator::offset_um().\ninline constexpr " + scalar + " " + request.unit.identifier +
         "_per_um = " + text(static_cast<Scalar>(request.unit.per_um)) + ";\n\n}  // namespace " + request.name + "\n";
}

}  // namespace

ControllerSource export_cpp(const ExportRequest& request) {
  return "#pragma once\n\n// Thermal compensation for thermfit/controller, C++17: `" + request.name +
         "::Compensator device(" + request.name + "::model, " + request.name + "::settings);`\n" +
         fact_comment(request, "//") + "\n#include \"thermfit/controller/compensator.hpp\"\n\n" +
         (request.single_precision ? cpp_compensator<float>(request) : cpp_compensator<double>(request));
}

}  // namespace thermfit::cli
