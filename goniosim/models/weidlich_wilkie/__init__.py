"""Weidlich and Wilkie 2007/2009 and its variants: lobes of the interfaces, weighted by the crossings above them."""
