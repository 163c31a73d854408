#pragma once

#include <string>
#include <vector>

namespace thermfit {

/// A robustness figure somebody published, to be shown beside one's own.
struct PublishedFigure {
  std::string method;    ///< its name as published, e.g. "MLR on FCGR"
  int points = 0;        ///< temperature points used
  double S_mean_um = 0;  ///< mean of S over batches, um
  double S_std_um = 0;   ///< standard deviation of S over batches, um
};

/// What a folder of batches says of itself: the in-memory `thermfit-campaign/1`.
struct CampaignCard {
  std::string title;                       ///< one line: which machine, how many batches
  std::string origin;                      ///< "measured" or "simulated"
  std::string remark;                      ///< what a reader must know before using the data; may be empty
  std::string published_source;            ///< who published the figures, and on which data
  std::vector<PublishedFigure> published;  ///< in the order of the card; empty where nobody published any
};

}  // namespace thermfit
