"""The program in other forms, each as data, as a picture and as text: ladder, chart (SFC) and highlighted instruction list.

from ecsim.views.ladder import ladder
from ecsim.views.sfc import chart
from ecsim.views.listing import listing
"""
