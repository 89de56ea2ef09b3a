"""Fits smooth curves to clogging lengths: lambda against one or two keys of a sweep.

- model: the Gaussian process, a fit that knows only numbers
- features: band, peak and crossings of a fitted curve
- points: which groups of clogfit's table belong to a curve, and why others do not
- answer: the curves of a sweep, as `clogfit curve --format json` prints them
- table: these curves as text and CSV
"""
