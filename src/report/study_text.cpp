#include "report/study_text.hpp"

#include <algorithm>
#include <cmath>

#include "cli/labels.hpp"
#include "cli/table.hpp"
#include "options/error_reference.hpp"
#include "options/field_flags.hpp"
#include "report/model_text.hpp"
#include "report/transfer_text.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

std::string upper_name(Method method) {
  switch (method) {
    case Method::pls:
      return "PLS";
    case Method::mlr:
      return "MLR";
    case Method::pcr:
      return "PCR";
    case Method::ridge:
      break;
  }
  return "ridge";
}

std::string percent(double share) { return fixed_text(100 * share, 1) + " %"; }

/// A table of batches by batches with more columns is not read by anybody.
constexpr Index most_columns = 20;

bool has_blank(const Labels& labels) {
  return std::any_of(labels.all().begin(), labels.all().end(),
                     [](const std::string& label) { return label.find(' ') != std::string::npos; });
}

/// One error's part of the report.
class ErrorSection {
 public:
  ErrorSection(const StudyReport& report, std::size_t error, const Labels& batches, const Labels& sensors,
               Console& console)
      : r_(report), e_(error), error_(report.errors[error]), batches_(batches), sensors_(sensors), console_(console) {}

  void print() const {
    advice();
    summary();
    if (e_ == 0) console_.print(legends(batches_, sensors_));
    correlations();
    const StudiedMethod<>& first = r_.study.methods.front();
    if (const SweepStep<>* step = first.chosen()) {
      models(first, *step);
      matrix(first, *step);
    }
    sweep();
    comparison();
    left_out();
  }

 private:
  void heading(const std::string& text) const { console_.print("\n" + wrap(console_.strong(text), 80, 2) + "\n"); }

  const Robustness<>* figures(const StudiedMethod<>& method) const {
    const SweepStep<>* step = method.chosen();
    return step ? &step->robustness[e_] : nullptr;
  }

  /// The paper's baseline: MLR on FCGR points.
  const StudiedMethod<>* baseline() const {
    for (const StudiedMethod<>& method : r_.study.methods)
      if (method.method == Method::mlr && method.selection == Selection::fcgr) return &method;
    return nullptr;
  }

  std::string points(const std::vector<Index>& chosen) const {
    std::string text;
    for (const Index point : chosen) text += (text.empty() ? "" : between_) + sensors_[static_cast<std::size_t>(point)];
    return text;
  }

  void summary() const {
    const Robustness<>* ours = figures(r_.study.methods.front());
    if (!ours) return;
    std::string text = method_title(r_.study.methods.front()) + ", " + std::to_string(r_.study.options.points) +
                       " points: S_mean " + fixed_text(ours->per_model.S_mean, 2) + " um, S_std " +
                       fixed_text(ours->per_model.S_std, 2) + " um for " + error_ +
                       (r_.error_reference == ErrorReference::recorded ? "" : " " + in_words(r_.error_reference)) +
                       (r_.study.options.own_batch ? " over all batches" : " on batches a model was not made from");
    if (const StudiedMethod<>* base = baseline())
      if (const Robustness<>* theirs = figures(*base)) {
        const double accuracy = 1 - ours->per_model.S_mean / theirs->per_model.S_mean;
        const double robust = 1 - ours->per_model.S_std / theirs->per_model.S_std;
        const auto compared = [](double share, const char* word) {
          return percent(std::abs(share)) + (share < 0 ? " less " : " more ") + word;
        };
        if (std::isfinite(accuracy))  // where the other leaves nothing there is nothing to compare with
          text += ": " + compared(accuracy, "accurate") +
                  (std::isfinite(robust) ? " and " + compared(robust, "robust") : "") + " than " + method_title(*base);
      }
    console_.line();
    console_.print(wrap(text + ".", 80, 0));
  }

  /// A way to predict batches that were not used: its name, the command that fits it, its figures.
  struct Candidate {
    std::string title, command;
    MeanAndStd<> figure;
    double worst_S;
    std::size_t worst_batch;
  };

  static Candidate candidate(std::string title, std::string command, const std::vector<std::vector<Residuals<>>>& left,
                             std::size_t error) {
    Candidate result{std::move(title), std::move(command), figure_of(left, error), 0, 0};
    for (std::size_t b = 0; b < left.size(); ++b)
      if (left[b][error].S() > result.worst_S) result.worst_S = left[b][error].S(), result.worst_batch = b;
    return result;
  }

  std::vector<Candidate> candidates() const {
    std::vector<Candidate> all;
    if (r_.transfer) all.push_back(candidate("transfer", "--method transfer", r_.transfer->residuals, e_));
    for (const LeftOutMethod<>& row : r_.study.left_out) {
      if (!row.result) continue;
      const std::string components = row.components > 0 ? " --components " + std::to_string(row.components) : "";
      all.push_back(candidate(title(row), std::string("--method ") + name(row.method) + components + " --points all",
                              row.result->residuals, e_));
    }
    const auto unknown = [](const Candidate& one) { return !std::isfinite(one.figure.S_mean); };  // batches of one row
    all.erase(std::remove_if(all.begin(), all.end(), unknown), all.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const Candidate& a, const Candidate& b) { return a.figure.S_mean < b.figure.S_mean; });
    return all;
  }

  /// What to take: the way that predicts batches best that it was not made from.
  void advice() const {
    const std::vector<Candidate> all = candidates();
    if (all.empty()) return;
    const Candidate& best = all.front();
    std::string text = "Each batch predicted by one model of all the others: " + best.title + " is best for " + error_ +
                       ", " + in_words(best.figure) + ", at worst " + fixed_text(best.worst_S, 2) + " um on " +
                       r_.batches[best.worst_batch];
    if (all.size() > 1) text += "; next " + all[1].title + ", " + in_words(all[1].figure);
    if (const Robustness<>* paper = figures(r_.study.methods.front()))
      text += ". The paper's way, one batch a model: " + in_words(paper->per_model) +
              " (pooled over all pairs: S_std " + fixed_text(paper->pooled.S_std, 2) + " um)";
    console_.line();
    console_.print(wrap(text + ".", 80, 0));
    const bool start = r_.error_reference != ErrorReference::recorded;
    console_.print(wrap("To take it: thermfit fit … " + best.command +
                            (start ? std::string(" --error-reference ") + name(r_.error_reference) : "") +
                            " -o model.json",
                        80, 2));
  }

  void correlations() const {
    const StudiedMethod<>& first = r_.study.methods.front();
    heading("Correlation with " + error_ + ", and the " + std::to_string(r_.study.options.points) +
            " points chosen in each batch");
    std::vector<std::string> header{"batch"};
    header.insert(header.end(), sensors_.all().begin(), sensors_.all().end());
    header.emplace_back("chosen");
    Table table(header);
    table.left(header.size() - 1);
    for (std::size_t b = 0; b < r_.batches.size(); ++b) {
      std::vector<std::string> row{batches_[b]};
      for (Index p = 0; p < r_.study.points; ++p)
        row.push_back(known_text(r_.study.correlations[b](p, static_cast<Index>(e_)), 2));
      row.push_back(first.chosen() ? points(first.chosen()->models[b].points) : "");
      table.add(row);
    }
    console_.print(table.text());
  }

  void models(const StudiedMethod<>& method, const SweepStep<>& step) const {
    heading("Coefficients of each batch's " + upper_name(method.method) +
            " model, um and um/K, and the points FCGR chooses");
    const std::size_t k = static_cast<std::size_t>(step.points);
    std::vector<std::string> header{"batch", "comp.", "T expl.", "own S", "intercept"};
    for (std::size_t i = 1; i <= k; ++i) header.push_back("um/K " + std::to_string(i));
    header.emplace_back("FCGR");
    Table table(header);
    table.left(header.size() - 1);
    const StudiedMethod<>* base = baseline();
    for (std::size_t b = 0; b < step.models.size(); ++b) {
      const BatchModel<>& m = step.models[b];
      const Index batch = static_cast<Index>(b), error = static_cast<Index>(e_);
      const Vector& explained = m.fit.latent.explained_temperature_variance;
      std::vector<std::string> row{batches_[b], std::to_string(m.fit.components),
                                   explained.size() ? percent(explained(explained.size() - 1)) : "",
                                   fixed_text(step.S[e_](batch, batch), 2),
                                   fixed_text(m.fit.model.intercept(error), 3)};
      for (std::size_t i = 0; i < m.points.size(); ++i)
        row.push_back(fixed_text(m.fit.model.coefficients(static_cast<Index>(i), error), 3) + ' ' +
                      points({m.points[i]}));
      row.resize(header.size() - 1);
      row.push_back(base && base->chosen() ? points(base->chosen()->models[b].points) : "");
      table.add(row);
    }
    console_.print(table.text());
  }

  void matrix(const StudiedMethod<>& method, const SweepStep<>& step) const {
    heading("S of each batch's " + upper_name(method.method) + " model (row) on each batch (column), um");
    const Matrix& S = step.S[e_];
    const Robustness<>& robust = step.robustness[e_];
    if (S.rows() > most_columns) {
      print_models(S, robust);
      console_.print(wrap("All " + std::to_string(S.rows()) + " x " + std::to_string(S.cols()) +
                              " figures are in the output of --json.",
                          80, 0));
      return;
    }
    std::vector<std::string> header{"model"};
    header.insert(header.end(), batches_.all().begin(), batches_.all().end());
    Table table(header);
    const int decimals = S.maxCoeff() < 10 ? 2 : 1;
    for (Index i = 0; i < S.rows(); ++i) {
      std::vector<std::string> row{batches_[static_cast<std::size_t>(i)]};
      for (Index j = 0; j < S.cols(); ++j) row.push_back(fixed_text(S(i, j), decimals));
      table.add(row);
    }
    console_.print(table.text());
    console_.line();
    print_models(S, robust);
  }

  void print_models(const Matrix& S, const Robustness<>& robust) const {
    Table summary({"model", "S_mean", "S_std", "largest S", "on"});
    for (Index i = 0; i < S.rows(); ++i) {
      Index worst = i == 0 ? 1 : 0;
      for (Index j = 0; j < S.cols(); ++j)
        if ((j != i || r_.study.options.own_batch) && S(i, j) > S(i, worst)) worst = j;
      const MeanAndStd<>& figure = robust.models[static_cast<std::size_t>(i)];
      summary.add({batches_[static_cast<std::size_t>(i)], fixed_text(figure.S_mean, 2), fixed_text(figure.S_std, 2),
                   fixed_text(S(i, worst), 2), batches_[static_cast<std::size_t>(worst)]});
    }
    summary.rule();
    summary.add({"per model", fixed_text(robust.per_model.S_mean, 2), fixed_text(robust.per_model.S_std, 2),
                 fixed_text(robust.worst_S, 2), batches_[static_cast<std::size_t>(robust.worst_batch)]});
    summary.add({"pooled", fixed_text(robust.pooled.S_mean, 2), fixed_text(robust.pooled.S_std, 2)});
    console_.print(summary.text());
  }

  void sweep() const {
    heading("Number of temperature points: S_mean/S_std per model, um");
    std::vector<std::string> header{"points"};
    for (const StudiedMethod<>& method : r_.study.methods)
      header.push_back(upper_name(method.method) + (method.components > 0 ? ", 1 c." : "") +
                       (method.selection == Selection::fcgr ? ", FCGR" : ""));
    Table table(header);
    for (std::size_t k = 0; k < r_.study.methods.front().sweep.size(); ++k) {
      std::vector<std::string> row{std::to_string(k + 1)};
      for (const StudiedMethod<>& method : r_.study.methods) {
        if (!method.sweep[k]) {
          row.emplace_back("-");
          continue;
        }
        const MeanAndStd<>& figure = method.sweep[k]->robustness[e_].per_model;
        row.push_back(fixed_text(figure.S_mean, 2) + '/' + fixed_text(figure.S_std, 2));
      }
      table.add(row);
    }
    console_.print(table.text());
    std::vector<std::string> told;
    for (const StudiedMethod<>& method : r_.study.methods)
      if (!method.refusal.empty() && std::find(told.begin(), told.end(), method.refusal) == told.end()) {
        told.push_back(method.refusal);
        console_.print(wrap("-  " + method_title(method) + ": " + with_flags(method.refusal), 80, 3));
      }
  }

  void comparison() const {
    heading("Methods side by side at " + std::to_string(r_.study.options.points) +
            " points, um; percentages against MLR on FCGR; pooled: S_std over all pairs");
    Table table({"method", "S_mean", "S_std", "pooled", "worst S of, on"});
    const StudiedMethod<>* base = baseline();
    const Robustness<>* reference = base ? figures(*base) : nullptr;
    const auto compared = [](double value, std::optional<double> against) {
      if (!against) return fixed_text(value, 2) + "          ";
      const double change = 100 * (value / *against - 1);
      std::string share = (change < 0 ? "" : "+") + fixed_text(change, 1) + " %)";
      return fixed_text(value, 2) + std::string(9 - std::min<std::size_t>(8, share.size()), ' ') + '(' + share;
    };
    for (const StudiedMethod<>& method : r_.study.methods) {
      const Robustness<>* f = figures(method);
      if (!f) {
        table.add({method_title(method), "-"});
        continue;
      }
      const bool percentages = reference && &method != base;
      const auto against = [&](double value) { return percentages ? std::optional<double>(value) : std::nullopt; };
      table.add({method_title(method),
                 compared(f->per_model.S_mean, against(reference ? reference->per_model.S_mean : 0)),
                 compared(f->per_model.S_std, against(reference ? reference->per_model.S_std : 0)),
                 fixed_text(f->pooled.S_std, 2),
                 fixed_text(f->worst_S, 1) + " " + batches_[static_cast<std::size_t>(f->worst_model)] + "," +
                     batches_[static_cast<std::size_t>(f->worst_batch)]});
    }
    const bool quoted = r_.card && e_ == 0 && !r_.card->published.empty();
    if (quoted) {
      table.rule();
      const PublishedFigure& last = r_.card->published.back();
      for (const PublishedFigure& figure : r_.card->published) {
        const bool percentages = &figure != &last;
        const auto against = [&](double value) { return percentages ? std::optional<double>(value) : std::nullopt; };
        table.add({figure.method + ", published", compared(figure.S_mean_um, against(last.S_mean_um)),
                   compared(figure.S_std_um, against(last.S_std_um))});
      }
    }
    console_.print(table.text());
    if (quoted) console_.print(wrap("Published: " + r_.card->published_source + ".", 80, 2));
  }

  static std::string title(const LeftOutMethod<>& row) {
    std::string text = upper_name(row.method);
    if (row.components > 0)
      text += ", " + std::to_string(row.components) + (row.components > 1 ? " components" : " component");
    return text;
  }

  /// The row of the method transfer, and what it chose.
  std::string add_transfer(Table& table) const {
    if (!r_.transfer) {
      table.add({"transfer", "-"});
      return "-  transfer: " + with_flags(r_.transfer_refusal);
    }
    LeftOut<> left;
    left.residuals = r_.transfer->residuals;
    const std::size_t worst = left.worst(e_, &Residuals<>::rmse);
    table.add({"transfer", fixed_text(left.mean(e_, &Residuals<>::rmse), 2),
               fixed_text(left.residuals[worst][e_].rmse(), 2), batches_[worst], fixed_text(left.pooled(e_).rmse(), 2),
               fixed_text(left.mean(e_, &Residuals<>::rmse_without_bias), 2)});
    std::vector<std::pair<std::string, std::size_t>> chosen;
    for (const auto& fits : r_.transfer->fits) {
      const std::string words = in_words(fits[e_].penalties, r_.transfer_lags_min);
      const auto same = std::find_if(chosen.begin(), chosen.end(), [&](const auto& one) { return one.first == words; });
      if (same == chosen.end())
        chosen.emplace_back(words, 1);
      else
        ++same->second;
    }
    std::string text = "transfer chose without the batch:";
    for (std::size_t c = 0; c < chosen.size(); ++c)
      text += (c ? "; " : " ") + chosen[c].first + " (" + std::to_string(chosen[c].second) + " of " +
              std::to_string(r_.batches.size()) + ")";
    std::string beyond;
    for (std::size_t b = 0; b < r_.transfer->beyond_K.size(); ++b) {
      if (!(r_.transfer->beyond_K[b] >= .05)) continue;  // one decimal is told
      beyond += (beyond.empty() ? "" : "; ") + r_.batches[b] + " by " + fixed_text(r_.transfer->beyond_K[b], 1) +
                " K (S " + fixed_text(r_.transfer->residuals[b][e_].S(), 2) + " um";
      if (r_.transfer->withheld_um[b][e_] > 0)
        beyond += ", with " + fixed_text(r_.transfer->withheld_um[b][e_], 2) + " um of the climate's part held back";
      beyond += ")";
    }
    return beyond.empty() ? text : text + ". Beyond the climates of the others start: " + beyond;
  }

  void left_out() const {
    heading("Each batch left out and predicted by one model of all the others, all " + std::to_string(r_.study.points) +
            " points: RMSE over batches, um");
    Table table({"method", "mean", "worst", "batch", "pooled", "bias off"});
    for (const LeftOutMethod<>& row : r_.study.left_out) {
      if (!row.result) {
        table.add({title(row), "-"});
        console_.print(wrap("-  " + title(row) + ": " + with_flags(row.refusal), 80, 3));
        continue;
      }
      const std::size_t worst = row.result->worst(e_, &Residuals<>::rmse);
      table.add({title(row), fixed_text(row.result->mean(e_, &Residuals<>::rmse), 2),
                 fixed_text(row.result->residuals[worst][e_].rmse(), 2), batches_[worst],
                 fixed_text(row.result->pooled(e_).rmse(), 2),
                 fixed_text(row.result->mean(e_, &Residuals<>::rmse_without_bias), 2)});
    }
    const std::string chosen = add_transfer(table);
    console_.print(table.text());
    console_.print(wrap(chosen, 80, 2));
  }

  const StudyReport& r_;
  std::size_t e_;
  const std::string& error_;
  const Labels &batches_, &sensors_;
  const std::string between_ = has_blank(sensors_) ? ", " : " ";  ///< names of points
  Console& console_;
};

}  // namespace

std::string method_title(const StudiedMethod<>& method) {
  return upper_name(method.method) + (method.components > 0 ? ", 1 component" : "") +
         (method.selection == Selection::fcgr ? " on FCGR"
          : method.components > 0             ? ""
                                              : " on correlation");
}

void print_study(const StudyReport& report, Console& console) {
  Index rows = 0;
  for (const Index n : report.rows) rows += n;
  std::string errors;
  for (const std::string& error : report.errors) errors += (errors.empty() ? "" : ", ") + error;
  console.print(
      wrap("Study of " + std::to_string(report.batches.size()) + " batches, " + std::to_string(rows) + " rows, " +
               std::to_string(report.temperatures.size()) + " temperature points, error " + errors +
               (report.error_reference == ErrorReference::recorded ? "" : " " + in_words(report.error_reference)) +
               "; " + reference_in_words(report.reference) + ".",
           80, 0));
  if (report.card) {
    const std::string origin = report.card->origin == "simulated" ? "These data are simulated: " : "Measured: ";
    console.print(wrap(origin + report.card->title + ". " + report.card->remark, 80, 0));
  }
  const bool matrix = report.batches.size() <= static_cast<std::size_t>(most_columns);
  const Labels batches(report.batches, 'b', matrix ? label_width(report.batches.size()) : 16);
  const Labels sensors(report.temperatures, 'p', label_width(report.temperatures.size()));
  for (std::size_t e = 0; e < report.errors.size(); ++e) ErrorSection(report, e, batches, sensors, console).print();
}

}  // namespace thermfit::cli
