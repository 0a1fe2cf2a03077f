"""Number and first seed of the random cases of a property test; property_cases.hpp is its like for C++."""
import math
import os


def property_cases(usual):
    """CUSP_PROPERTY_CASES, or the share CUSP_PROPERTY_SHARE (0 to 1, default 1) of `usual`, rounded up."""
    if "CUSP_PROPERTY_CASES" in os.environ:
        return int(os.environ["CUSP_PROPERTY_CASES"])
    return math.ceil(float(os.environ.get("CUSP_PROPERTY_SHARE", 1)) * usual)


def property_seed(usual):
    """CUSP_PROPERTY_FIRST, or `usual`."""
    return int(os.environ.get("CUSP_PROPERTY_FIRST", usual))


def share_of(cases):
    """As many of a list of cases as property_cases() says, spread over it: the first one is among them."""
    wanted = property_cases(len(cases))
    return [cases[i * len(cases) // wanted] for i in range(wanted)] if wanted < len(cases) else list(cases)
