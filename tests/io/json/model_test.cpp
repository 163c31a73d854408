#include "thermfit/io/json/model.hpp"

#include <cstdio>
#include <filesystem>

#include "support/catch.hpp"
#include "support/transfer_campaign.hpp"
#include "thermfit/fit/train_transfer.hpp"

using namespace thermfit;

namespace {

TrainedModel example() {
  TrainedModel m;
  m.tool_version = THERMFIT_VERSION;
  m.method = "pls";
  m.selection = "correlation";
  m.temperatures = {"T5", "T1"};
  m.errors = {"Z"};
  m.components = 1;
  m.model.intercept = Vector::Constant(1, 6.258);
  m.model.coefficients = (Matrix(2, 1) << 1.811, 1.0 / 3).finished();
  m.standardised_coefficients = (Matrix(2, 1) << .473, .465).finished();
  m.temperature_mean = (Vector(2) << 4.5, 5.5).finished();
  m.temperature_scale = (Vector(2) << .1, 1e-300).finished();
  m.error_mean = m.error_scale = m.residual_deviation_um = Vector::Constant(1, 2.5);
  m.degrees_of_freedom = 77;
  m.condition_number = 40;
  LatentVariables<>& v = m.latent;
  v.weights = v.loadings = v.rotations = (Matrix(2, 1) << .701, .713).finished();
  v.error_loadings = Matrix::Constant(1, 1, .6637);
  v.explained_temperature_variance = v.explained_error_variance = Vector::Constant(1, .9988);
  v.vip = Vector::Ones(2);
  TrainingDomain<>& d = m.domain;
  d.lowest = d.mean = Vector::Zero(2);
  d.highest = d.scale = Vector::Ones(2);
  d.rotations = d.loadings = v.weights;
  d.score_variance = Vector::Ones(1);
  d.t2_limit_95 = 4, d.t2_limit_99 = 7, d.spe_limit_95 = .1, d.spe_limit_99 = .2;
  m.envelope = {Vector::Constant(2, 18), Vector::Constant(2, 31.5), Vector::Constant(2, .4), Vector::Constant(2, 25),
                Vector::Constant(2, 19), Vector::Constant(2, 22),   Vector::Constant(2, .2)};
  m.substitutes = {{0,
                    {(Matrix(2, 1) << 0, 3.6).finished(), Vector::Constant(1, 6)},
                    Vector::Constant(1, 3),
                    Vector::Constant(1, 8)}};
  m.batches = {{"K01", 79, std::string(64, 'a')}};
  return m;
}

std::string refusal(const Json& document) {
  try {
    model_from_json(document, "m.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Json with_digest(Json document) {
  document["digest"] = detail::model_digest(document);
  return document;
}

}  // namespace

TEST_CASE("a model saved and loaded is the same to the last bit", "[io]") {
  const std::string path = (std::filesystem::temp_directory_path() / "thermfit_model_json_test.json").string();
  save_model(example(), path);
  const TrainedModel loaded = load_model(path);
  std::remove(path.c_str());
  CHECK(model_to_json(loaded).dump() == model_to_json(example()).dump());
  CHECK(loaded.model.coefficients(1, 0) == 1.0 / 3);
  CHECK(loaded.temperatures == std::vector<std::string>{"T5", "T1"});
  CHECK(loaded.envelope.largest_rate_K_per_min(1) == .4);
  CHECK(loaded.substitutes.at(0).model.coefficients(1, 0) == 3.6);
}

TEST_CASE("a model on features saved and loaded is the same to the last bit", "[io]") {
  TransferPlan plan;
  plan.error_reference = ErrorReference::start;
  const TrainedModel model = train_transfer(TransferMachine{20, .1, .3, 4}.campaign(6, 90), plan);
  const Json document = model_to_json(model);
  const TrainedModel loaded = model_from_json(document, "m.json");
  CHECK(model_to_json(loaded) == document);
  CHECK(loaded.features.size() == model.features.size());
  CHECK(loaded.features[5].kind == FeatureKind::lag);
  CHECK(loaded.features[5].lag_min == model.features[5].lag_min);
  CHECK(loaded.climate.highest == model.climate.highest);
  CHECK(loaded.model.coefficients == model.model.coefficients);

  Json other = document;
  other["transfer"]["features"][5]["lag_min"] = 0;
  CHECK(refusal(with_digest(other)).find("lag") != std::string::npos);
  other = document;
  other["transfer"]["features"][0]["point"] = 4;
  CHECK(refusal(with_digest(other)).find("features[0].point") != std::string::npos);
  other = document;
  other["transfer"]["features"][0]["kind"] = "square";
  CHECK(refusal(with_digest(other)).find("difference") != std::string::npos);
  other = document;
  other["transfer"]["climate_lowest_degC"] = 1000;
  CHECK(refusal(with_digest(other)).find("climate_lowest_degC") != std::string::npos);
}

TEST_CASE("a model on known inputs says which, and a file that names one it has not is refused", "[io]") {
  Campaign campaign = TransferMachine{20, .1, .3, 0}.campaign(6, 90);
  for (Batch& batch : campaign) {
    batch.inputs = {{"rpm"}, Matrix::Zero(batch.rows(), 1)};
    for (Index row = 0; row < batch.rows(); ++row) batch.inputs.values(row, 0) = row % 20 < 10 ? 3000 : 0;
    batch.errors.values += .003 * batch.inputs.values;
  }
  TransferPlan plan;
  plan.inputs = {"rpm"};
  const TrainedModel model = train_transfer(campaign, plan);
  REQUIRE(model.known_inputs == plan.inputs);
  const Json document = model_to_json(model);
  const TrainedModel loaded = model_from_json(document, "m.json");
  CHECK(model_to_json(loaded) == document);
  CHECK(loaded.known_inputs == model.known_inputs);
  std::size_t at = 0;
  while (document["transfer"]["features"][at]["kind"] != "input") ++at;
  CHECK(loaded.features[at].kind == FeatureKind::input);
  CHECK(loaded.input_name(static_cast<Index>(at)) == "rpm");
  Json other = document;
  other["transfer"]["features"][at]["input"] = 1;
  CHECK(refusal(with_digest(other)).find("].input") != std::string::npos);
  other = document;
  other["transfer"].erase("known_inputs");
  CHECK(refusal(with_digest(other)).find("].input") != std::string::npos);
}

TEST_CASE("an edited number is found by the digest", "[io]") {
  Json document = model_to_json(example());
  document["intercept_um"][0] = 6.259;
  CHECK(refusal(document) ==
        "m.json: digest: the digest does not fit the content; the file was edited or damaged: fit the model again");
}

TEST_CASE("a model file cut at any byte is refused", "[io]") {
  const std::string text = model_to_json(example()).dump(1);
  for (std::size_t length = 0; length < text.size(); ++length)
    CHECK_THROWS_AS(model_from_json(parse_json(text.substr(0, length), "m.json"), "m.json"), Error);
}

TEST_CASE("a model file with any one bit flipped is refused or means the same", "[io]") {
  const std::string text = model_to_json(example()).dump();
  const std::string same = model_to_json(example()).dump();
  int accepted = 0;
  for (std::size_t i = 0; i < text.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = text;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      try {
        if (model_to_json(model_from_json(parse_json(damaged, "m"), "m")).dump() != same) FAIL("read as another model");
        ++accepted;
      } catch (const Error&) {
      }
    }
  CHECK(accepted < 60);  // white space and the last digits that round to the same double
}

TEST_CASE("hostile counts and shapes are refused before memory is taken", "[io]") {
  Json document = model_to_json(example());
  SECTION("a negative number of components") {
    document["components"] = -5;
    CHECK(refusal(with_digest(document)) == "m.json: components: value -5; allowed: a whole number from 0 to 2");
  }
  SECTION("more components than sensors") {
    document["components"] = 2147483647;
    CHECK(refusal(with_digest(document)).find("from 0 to 2") != std::string::npos);
  }
  SECTION("coefficients of another length") {
    document["um_per_K"] = Json::array({Json::array({1.0})});
    CHECK(refusal(with_digest(document)) == "m.json: um_per_K: a list of 1 rows; allowed: exactly 2");
  }
  SECTION("a scale of zero") {
    document["temperature_scale"][0] = 0.0;
    CHECK(refusal(with_digest(document)).find("not above 0") != std::string::npos);
  }
  SECTION("text for a number") {
    document["intercept_um"][0] = "6";
    CHECK(refusal(with_digest(document)) == "m.json: intercept_um[0]: found \"6\"; allowed: a number");
  }
  SECTION("a key of somebody else's") {
    document["author"] = "x";
    CHECK(refusal(with_digest(document)).find("unknown key 'author'") != std::string::npos);
  }
  SECTION("the same sensor twice") {
    document["temperatures"][1] = "T5";
    CHECK(refusal(with_digest(document)) == "m.json: temperatures[1]: 'T5' twice");
  }
  SECTION("another format") {
    CHECK(refusal(Json{{"format", "thermfit-machine/1"}}) ==
          "m.json: format: 'thermfit-machine/1'; allowed: 'thermfit-model/1'; is this the right file?");
    CHECK(refusal(Json::array()) == "m.json: no \"format\"; allowed: \"thermfit-model/1\"; is this the right file?");
  }
}

TEST_CASE("what errors are measured from is kept; files of earlier versions say nothing: as recorded", "[io]") {
  for (const ErrorReference reference : {ErrorReference::recorded, ErrorReference::start, ErrorReference::batch}) {
    TrainedModel model = example();
    model.error_reference = reference;
    const Json document = model_to_json(model);
    CHECK(document["error_reference"] == name(reference));
    CHECK(model_from_json(document, "model.json").error_reference == reference);
  }
  Json earlier = model_to_json(example());
  earlier.erase("error_reference");
  earlier["digest"] = detail::model_digest(earlier);
  CHECK(model_from_json(earlier, "model.json").error_reference == ErrorReference::recorded);
  Json other = model_to_json(example());
  other["error_reference"] = "first";
  CHECK(refusal(other).find("error_reference") != std::string::npos);
}
