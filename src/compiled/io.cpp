// io/ compiled ahead: files in, files out. What lies below comes from the other files of this library.
#include "thermfit/compiled.hpp"
#include "thermfit/model/trained_model.hpp"
#include "thermfit/moments/moments.hpp"
#include "thermfit/network/thermal_network.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE

#include <nlohmann/json.hpp>

#include "thermfit/io/csv/reader.hpp"
#include "thermfit/io/json/campaign.hpp"
#include "thermfit/io/json/machine.hpp"
#include "thermfit/io/json/model.hpp"
