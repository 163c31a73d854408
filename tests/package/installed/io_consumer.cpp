// Reads a campaign through thermfit::io: io_consumer FOLDER
#include <thermfit/io/csv/reader.hpp>
#include <thermfit/io/json/campaign.hpp>

int main(int, char** arguments) {
  const std::string folder = arguments[1];
  const thermfit::Campaign campaign = thermfit::read_campaign({folder + "/K01.csv", folder + "/K02.csv"}).batches;
  const thermfit::CampaignCard card = thermfit::read_campaign_card(folder + "/campaign.json");
  return campaign.size() == 2 && campaign[1].temperatures.names.at(9) == "T10" && card.origin == "simulated" ? 0 : 1;
}
