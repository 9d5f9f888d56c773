-- Stands in for schema 15 until it comes.
SELECT 15;
