#pragma once

#include <string>

#include "thermfit/batch/campaign_card.hpp"
#include "thermfit/io/json/node.hpp"

namespace thermfit {

/// Reads `campaign.json`: title, origin, remark and published figures of the batches beside it. Throws Error with the
/// key path on an unknown key or a value that does not fit.
template <typename J = Json>
CampaignCard read_campaign_card(const std::string& path) {
  const J document = read_json<J>(path, std::size_t{1} << 20);
  const BasicJsonNode<J> root(document, path);
  root.require_format("thermfit-campaign", 1);
  root.require_keys({"format", "title", "origin", "remark", "published"});
  CampaignCard card;
  card.title = root.at("title").text();
  card.origin = root.at("origin").choice({"measured", "simulated"});
  if (const auto remark = root.find("remark")) card.remark = remark->text(4000);
  if (const auto published = root.find("published")) {
    published->require_keys({"source", "figures"});
    card.published_source = published->at("source").text();
    const BasicJsonNode<J> figures = published->at("figures");
    for (std::size_t i = 0; i < figures.size(100); ++i) {
      const BasicJsonNode<J> figure = figures.item(i);
      figure.require_keys({"method", "points", "S_mean_um", "S_std_um"});
      card.published.push_back({figure.at("method").text(), static_cast<int>(figure.at("points").integer(1, 10000)),
                                figure.at("S_mean_um").number(0), figure.at("S_std_um").number(0)});
    }
  }
  return card;
}

THERMFIT_COMPILED_TEMPLATE(CampaignCard read_campaign_card<Json>(const std::string&));

}  // namespace thermfit
