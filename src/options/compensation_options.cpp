#include "options/compensation_options.hpp"

namespace thermfit::cli {

std::vector<Option> compensation_options() {
  return {
      {"--period", "S", "seconds from one step to the next; default 1", 0, false},
      {"--sign", "SIGN", "what the offset is: correction (default, minus the predicted error) or error", 0, false},
      {"--zero", "WHEN",
       "what corrections are relative to without a datum or a retained zero: wait (default, offset 0 "
       "and state no datum until there is one) or first (the first samples: only for machines always started cold)",
       0, false},
      {"--through-zero", "", "with --zero first: no intercept, offset 0 at the zero; after a datum always", 0, false},
      {"--stale-after", "S", "the same heartbeat for so long makes readings stale; default 5", 0, false},
      {"--clamp", "UM", "the offset stays within +-UM; default: |mean| + 4 deviations of the training errors", 0,
       false},
      {"--slew", "UM_PER_S", "the offset moves at most so fast; default 1", 0, false},
      {"--hold-timeout", "S", "an offset is held so long, then ramps to zero; default 600", 0, false},
      {"--lost-after", "S", "bad readings for so long make a sensor lost; default 5", 0, false},
      {"--recover-after", "S", "good readings for so long make it trusted again; default 30", 0, false},
      {"--range-margin", "K", "readings may lie so far outside those of training; default 20", 0, false},
      {"--probe-limit", "UM", "a probe corrects by no more; default: the clamp", 0, false},
      {"--probe-age", "MIN", "a probe's reading counts so long; default: to the next", 0, false},
      {"--domain", "POLICY", "outside the training domain: ignore, warn (default), shrink, hold", 0, false},
      {"--domain-limit", "PERCENT", "the domain holds 95 or 99 (default) percent of ordinary samples", 0, false},
  };
}

CompensationWishes compensation_wishes(const Arguments& arguments) {
  CompensationWishes wishes;
  wishes.period_s = arguments.number("--period", 1e-6, 86400).value_or(wishes.period_s);
  wishes.clamp_um = arguments.number("--clamp", 1e-3, 1e6);
  wishes.slew_um_per_s = arguments.number("--slew", 1e-6, 1e6).value_or(wishes.slew_um_per_s);
  wishes.hold_s = arguments.number("--hold-timeout", 0, 1e6).value_or(wishes.hold_s);
  wishes.lost_after_s = arguments.number("--lost-after", 0, 1e6).value_or(wishes.lost_after_s);
  wishes.recover_after_s = arguments.number("--recover-after", 0, 1e6).value_or(wishes.recover_after_s);
  wishes.range_margin_K = arguments.number("--range-margin", 0, 1000).value_or(wishes.range_margin_K);
  wishes.zero = arguments.choice("--zero", {"wait", "first"}, "wait") == "first" ? ZeroPolicy::first : ZeroPolicy::wait;
  wishes.probe_largest_um = arguments.number("--probe-limit", 0, 1e6);
  wishes.probe_age_s = 60 * arguments.number("--probe-age", 0, 1e7).value_or(wishes.probe_age_s / 60);
  wishes.through_zero = arguments.has("--through-zero");
  wishes.stale_s = arguments.number("--stale-after", 1e-6, 1e6).value_or(wishes.stale_s);
  if (arguments.choice("--sign", {"correction", "error"}, "correction") == "error") wishes.sign = OutputSign::error;
  const std::string policy = arguments.choice("--domain", {"ignore", "warn", "shrink", "hold"}, "warn");
  wishes.domain_policy = policy == "ignore"   ? DomainPolicy::ignore
                         : policy == "shrink" ? DomainPolicy::shrink
                         : policy == "hold"   ? DomainPolicy::hold
                                              : DomainPolicy::warn;
  if (arguments.choice("--domain-limit", {"95", "99"}, "99") == "95") wishes.domain_limit = DomainLimit::percent_95;
  return wishes;
}

}  // namespace thermfit::cli
