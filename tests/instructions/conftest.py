"""What the tests of single instructions share: a running PLC on each engine."""

from functools import cache

import pytest

import ecsim


@pytest.fixture(scope="module", params=["compiled", "stepping"])
def running(request):
    """A function from a program to a PLC in RUN with it, once on either engine; asked again it gives the same PLC."""

    @cache
    def plc_with(il, model="EC20"):
        plc = ecsim.Plc(model, input_filter_ms=0)
        plc.tracing = request.param == "stepping"
        plc.load(il)
        plc.run()
        return plc

    return plc_with
