#include "export/reserved_words.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "export/source_text.hpp"

namespace thermfit::cli {
namespace {

struct Language {
  const char* name;
  bool ignores_case;
  std::string_view words;  ///< one space between them
};

// clang-format off
const Language languages[] = {
    // Keywords, and what <math.h>, <stdint.h> and the like put into the one name space there is.
    {"C", false,
     "abs acos alignas alignof asin asm assert atan atan2 auto bool break case ceil char clock const constexpr "
     "continue cos cosh default do double else enum errno exit exp exp2 extern fabs false float floor fmax fmin "
     "fmod for fortran free goto hypot if inline int int16_t int32_t int64_t int8_t isfinite isinf isnan log "
     "log10 log2 long main malloc memcpy memset nullptr pow printf register restrict return round short signal "
     "signed sin sinh size_t sizeof sqrt static static_assert struct switch tan tanh thread_local time true "
     "trunc typedef typeof typeof_unqual uint16_t uint32_t uint64_t uint8_t union unsigned void volatile while"},
    {"C++", false,
     "abs acos alignas alignof and and_eq asin asm assert atan atan2 auto bitand bitor bool break case catch "
     "ceil char char16_t char32_t char8_t class clock co_await co_return co_yield compl concept const const_cast "
     "consteval constexpr constinit continue cos cosh decltype default delete do double dynamic_cast else enum "
     "errno exit exp exp2 explicit export extern fabs false final float floor fmax fmin fmod for free friend "
     "goto hypot if import inline int int16_t int32_t int64_t int8_t isfinite isinf isnan log log10 log2 long "
     "main malloc memcpy memset module mutable namespace new noexcept not not_eq nullptr operator or or_eq "
     "override posix pow printf private protected public register reinterpret_cast requires return round short "
     "signal signed sin sinh size_t sizeof sqrt static static_assert static_cast std struct switch tan tanh "
     "template thermfit this thread_local throw time true trunc try typedef typeid typename uint16_t uint32_t "
     "uint64_t uint8_t union unsigned using virtual void volatile wchar_t while xor xor_eq"},
    // IEC 61131-3, third edition, with what CODESYS and TwinCAT add: keywords, types, standard functions and blocks,
    // instructions.
    {"Structured Text", true,
     "abs abstract acos action add add_dt_time add_time add_tod_time adr and and_then andn any any_bit any_char "
     "any_chars any_date any_derived any_duration any_elementary any_int any_magnitude any_num any_real "
     "any_signed any_string any_unsigned array asin assert at atan atan2 bcd_to bit bitadr bool by byte cal calc "
     "calcn case char class concat concat_date concat_date_tod concat_dt concat_tod configuration constant "
     "continue cos ctd ctu ctud date date_and_time day_of_week delete dint div div_time divtime do dt dword else "
     "elsif en end_action end_case end_class end_configuration end_for end_function end_function_block end_if "
     "end_interface end_method end_namespace end_program end_property end_repeat end_resource end_step "
     "end_struct end_transition end_type end_union end_var end_while eno eq exit exp expt extends f_edge f_trig "
     "false final find for from from_big_endian from_little_endian function function_block ge goto gt if "
     "implements in indexof initial_step insert int interface internal interval is_valid is_valid_bcd jmp jmpc "
     "jmpcn ld ldate ldate_and_time ldn ldt le left len limit lint ln log lower_bound lreal lt ltime "
     "ltime_of_day ltod lword max method mid min mod move mul mul_time multime mux namespace ne nil non_retain "
     "not null of on or or_else orn overlap override persistent pointer priority private program property "
     "protected public r r_edge r_trig read_only read_write real ref ref_to reference repeat replace resource "
     "ret retain retc retcn return right rol ror rs rtc s sel sema shl shr sin single sint sizeof split_date "
     "split_dt split_tod sqrt sr st step stn string struct sub sub_date_date sub_dt_dt sub_dt_time sub_time "
     "sub_tod_time sub_tod_tod super tan task then this time time_of_day to to_bcd to_big_endian "
     "to_little_endian tod tof ton tp transition true trunc type udint uint ulint union until upper_bound using "
     "usint var var_access var_config var_external var_generic var_global var_in_out var_input var_inst "
     "var_output var_stat var_temp wchar while with word wstring xor xorn"},
    {"HAL", true,
     "abs abs_s32 and2 anglejog author axis axistest bin2gray biquad bit bitslice bitwise bldc blend boss_plc "
     "carousel charge_pump clarke2 clarke3 clarkeinv classicladder_rt comp component constant conv_bit_float "
     "conv_bit_s32 conv_bit_u32 conv_float_s32 conv_float_u32 conv_s32_bit conv_s32_float conv_s32_u32 "
     "conv_u32_bit conv_u32_float conv_u32_s32 corexy_by_hal corexykins counter data dbounce ddt deadzone "
     "debounce demux description differential div2 edge encoder encoder_ratio eoffset_per_angle estop_latch "
     "examples EXTRA_CLEANUP EXTRA_SETUP feedcomp filter_kalman flipflop float fperiod function FUNCTION gantry "
     "gearchange genhexkins genserkins gray2bin hal hal_bb_gpio hal_gm hal_lib hal_parport hal_pi_gpio hal_ppmc "
     "hal_speaker halcmd halrun haltcl halui histobins hm2_7i43 hm2_7i90 hm2_eth hm2_pci hm2_rpspi hm2_spi "
     "hm2_test homecomp homemod hostmot2 hypot ilowpass in include ini inihal integ invert io iocontrol joint "
     "joyhandle knob2float latencybins lcd license limit1 limit2 limit3 lincurve lineardeltakins logic lowpass "
     "lut5 maj3 match8 matrix_kb max31855 maxkins mesa_7i65 mesa_pktgyro_test mesa_uart message millturn minmax "
     "modmath modparam motion motmod moveoff mult2 multiclick multiswitch mux16 mux2 mux4 mux8 mux_generic near "
     "not notes offset ohmic oneshot option or2 orient out param pentakins period pid pin plasmac port pumakins "
     "pwmgen rosekins rotarydeltakins rotatekins rtapi rtapi_app rw s32 s64 sample_hold sampler scale "
     "scaled_s32_sums scarakins scope_rt scorbot_kins see_also select8 serport setsserial siggen signed "
     "sim_axis_hardware sim_encoder sim_home_switch sim_matrix_kb sim_parport sim_spindle simple_tp sphereprobe "
     "spindle spindle_monitor stepgen steptest streamer sum2 supply thc thcud threads threadtest time timedelay "
     "timedelta tof toggle toggle2nist ton tp tpmod tripodkins tristate_bit tristate_float trivkins u32 u64 "
     "unsigned updown userkins variable watchdog wcomp weighted_sum xhc_hb04_util xor2 xyzab_tdr_kins "
     "xyzac_trt_kins xyzbc_trt_kins"}};
// clang-format on

bool has_word(const Language& language, const std::string& name) {
  const auto folded = [&](std::string_view word) {
    return language.ignores_case ? upper_case(std::string(word)) : std::string(word);
  };
  const std::string wanted = folded(name);
  for (std::string_view rest = language.words; !rest.empty();) {
    const auto end = std::min(rest.find(' '), rest.size());
    if (folded(rest.substr(0, end)) == wanted) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

/// REAL_TO_INT, TO_INT, TRUNC_INT: every pair of types gives one.
bool is_conversion(const Language& structured_text, const std::string& name) {
  const std::string upper = upper_case(name);
  for (const std::string_view link : {"_TO_", "TO_", "TRUNC_"}) {
    const auto at = upper.find(link);
    if (at == std::string::npos || (link != "_TO_" && at != 0)) continue;
    const std::string from = upper.substr(0, at), to = upper.substr(at + link.size());
    const bool known_from = from.empty() || from == "BCD" || has_word(structured_text, from);
    if (known_from && (to == "BCD" || has_word(structured_text, to))) return true;
  }
  return false;
}

}  // namespace

std::string reserved_in(const std::string& name) {
  std::vector<std::string> found;
  for (const Language& language : languages)
    if (has_word(language, name) ||
        (language.name == std::string_view("Structured Text") && is_conversion(language, name)))
      found.push_back(language.name);
  std::string text;
  for (std::size_t k = 0; k < found.size(); ++k)
    text += (k == 0 ? "" : k + 1 == found.size() ? " and " : ", ") + found[k];
  return text;
}

}  // namespace thermfit::cli
