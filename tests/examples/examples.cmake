# What the programs of apps/examples must print, as regular expressions. Whoever includes this says how they are built:
# a function thermfit_add_example(name expected argument…).
thermfit_add_example(quick_start "S_mean 5.72 um, S_std 0.61 um" data/vcenter55/K01.csv data/vcenter55/K02.csv
                     data/vcenter55/K03.csv data/vcenter55/K04.csv data/vcenter55/K05.csv data/vcenter55/K06.csv
                     data/vcenter55/K07.csv data/vcenter55/K08.csv data/vcenter55/K09.csv data/vcenter55/K10.csv
                     data/vcenter55/K11.csv data/vcenter55/K12.csv)
thermfit_add_example(user_effect "with the machine: cold air comes in through the shop door .open-door at ambient., shrink 100 %
from outputs alone: cold air comes in through the shop door .open-door at ambient., shrink 98 %")
thermfit_add_example(controller_loop "1804 s: sensor 1 lost, its substitute works.*largest error left before the break: 0.12 um")
