// The instances of io/ that thermfit::compiled holds: files in, files out. What lies below is compiled elsewhere.
#include "thermfit/simulation.hpp"
#include "thermfit/study.hpp"

#undef THERMFIT_COMPILED_ELSEWHERE
#define THERMFIT_COMPILED_ELSEWHERE

#include "thermfit/io/csv/moments.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/io/json/campaign.hpp"
#include "thermfit/io/json/machine.hpp"
#include "thermfit/io/json/model.hpp"
