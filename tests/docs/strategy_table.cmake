# usage: cmake -D LIST=strategies.cmake -D TABLE=FILE.cpp -P strategy_table.cmake: writes the table of a list of strategies.
include(${LIST})
cusp_strategy_table(${TABLE})
