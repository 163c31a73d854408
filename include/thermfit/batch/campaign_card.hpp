#pragma once

#include <string>
#include <vector>

namespace thermfit {

/// A robustness figure somebody published, to be shown beside one's own.
struct PublishedFigure {
  std::string method;
  int points = 0;  ///< temperature points used
  double S_mean_um = 0, S_std_um = 0;
};

/// What a folder of batches says of itself: the in-memory `thermfit-campaign/1`.
struct CampaignCard {
  std::string title;
  std::string origin;  ///< "measured" or "simulated"
  std::string remark;
  std::string published_source;  ///< who published the figures, and on which data
  std::vector<PublishedFigure> published;
};

}  // namespace thermfit
